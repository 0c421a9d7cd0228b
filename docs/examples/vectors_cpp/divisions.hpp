// Algorithm 1: divide the shape that (16) picks, and solve again.
#pragma once

#include <vector>

#include "masses.hpp"
#include "shapes.hpp"

namespace example {

struct SoughtShape {
  Eigen::Index link;
  Cell cell;
};

struct Run {
  std::vector<double> places, masses, objectives;
  Eigen::VectorXd Phi;
};

inline MassProblem problem_of(const Eigen::MatrixXd& Y, const Eigen::VectorXd& F,
                              const Eigen::VectorXd& W, const std::vector<SoughtShape>& shapes,
                              double lambda, Eigen::VectorXd& V) {
  const auto n = static_cast<Eigen::Index>(shapes.size());
  Eigen::MatrixXd U = Eigen::MatrixXd::Zero(Y.cols(), n);
  V.resize(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const SoughtShape& shape = shapes[static_cast<std::size_t>(j)];
    const Solid made = solid(shape.cell);
    U.block(10 * shape.link, j, 10, 1) = parameters(made.moments);
    V[j] = made.volume;
  }
  return mass_problem(Y, F, W, U, V, lambda);
}

/// `given` holds lambda, k1, k2, tie, expected_mass and how many divisions.
inline Run divided(const Eigen::MatrixXd& Y, const Eigen::VectorXd& F, const Eigen::VectorXd& W,
                   std::vector<SoughtShape> shapes, const Json& given) {
  const double k1 = given["k1"].number(), k2 = given["k2"].number(),
               M0 = given["expected_mass"].number(), tie = given["tie"].number();
  Run run;
  for (int k = 0;; ++k) {
    Eigen::VectorXd V;
    const MassProblem p = problem_of(Y, F, W, shapes, given["lambda"].number(), V);
    const Eigen::VectorXd m = minimiser(p);
    run.masses.insert(run.masses.end(), m.begin(), m.end());
    run.objectives.push_back(p.objective(m));
    run.Phi = p.U * m;
    if (k == given["divisions"].integer()) return run;
    const Eigen::ArrayXd mass = m.array() / M0, size = V.array() / V.sum();
    const Eigen::ArrayXd v = k1 * mass * size + k2 * mass / size;
    Eigen::Index place = 0;
    while (v[place] < (1.0 - tie) * v.maxCoeff()) ++place;
    run.places.push_back(static_cast<double>(place));
    SoughtShape& cut_shape = shapes[static_cast<std::size_t>(place)];
    const auto [first, second] = halves(cut_shape.cell);
    cut_shape.cell = first;
    shapes.push_back({cut_shape.link, second});
  }
}

}  // namespace example
