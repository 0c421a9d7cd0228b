#include "shapeid/diagnosis/load_body.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <limits>
#include <vector>

#include "shapeid/diagnosis/load_places.hpp"
#include "shapeid/models/shape.hpp"
#include "shapeid/reference/mass_solver.hpp"

namespace shapeid::diagnosis {
namespace {

void set_points(MassProblem& problem, const std::vector<Eigen::Vector3d>& places) {
  problem.U.resize(10, std::ssize(places));
  for (Eigen::Index i = 0; i < problem.U.cols(); ++i) {
    problem.U.col(i) = unit_parameters(make_point(places[static_cast<std::size_t>(i)], 1.0)).values;
  }
  problem.V = Eigen::VectorXd::Ones(problem.U.cols());
}

}  // namespace

Violation why_no_load(const BlockFits::Beside& load) {
  const bool is_one =
      load.normal.rows() == 10 && load.normal.cols() == 10 && load.target.size() == 10;
  return is_one ? Violation() : "a load has ten numbers";
}

bool MostLost::allows(const LoadBody& body) const {
  return body.gain > 0.0 && body.lost <= std::max(error, share * (body.gain + body.lost));
}

LoadBody best_body(const BlockFits::Beside& load, const Box& room,
                   const std::optional<MostLost>& enough) {
  SHAPEID_CONTRACT(why_no_load(load));
  // Rows whose squares are the load's normal matrix, without the directions that no data show.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(load.normal);
  const Eigen::VectorXd& squares = eigen.eigenvalues();
  const double rounding =
      static_cast<double>(squares.size()) * std::numeric_limits<double>::epsilon();
  const auto shown = squares.array() > rounding * std::max(squares.maxCoeff(), 0.0);
  const Eigen::VectorXd length = shown.select(squares, 0.0).cwiseSqrt();
  MassProblem problem;
  problem.Y = length.asDiagonal() * eigen.eigenvectors().transpose();
  problem.F =
      shown.select((eigen.eigenvectors().transpose() * load.target).array() / length.array(), 0.0);
  problem.W = Eigen::VectorXd::Ones(10);

  std::vector<Eigen::Vector3d> places = first_places(room);
  LoadBody body;
  body.Phi = Eigen::VectorXd::Zero(10);
  constexpr int rounds = 10;
  constexpr double nothing = 1e-3;  // of the gain
  const double all = problem.F.squaredNorm();
  for (int round = 0; round < rounds; ++round) {
    set_points(problem, places);
    body.Phi = reference::solve_masses(problem).Phi;
    const Eigen::VectorXd left = problem.Y * body.Phi - problem.F;
    body.lost = left.squaredNorm();
    body.gain = all - body.lost;
    if (enough && enough->allows(body)) break;
    const SteepestPlace best = steepest_place(2.0 * problem.Y.transpose() * left, room);
    if (!(-best.slope * body.Phi[0] > nothing * all)) break;
    places.push_back(best.place);
  }
  return body;
}

}  // namespace shapeid::diagnosis
