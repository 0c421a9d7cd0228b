#include "shapeid/fast/solve_masses.hpp"

#include <cstddef>
#include <string>

#include "shapeid/fast/asked_of_masses.hpp"
#include "shapeid/fast/mass_solver.hpp"
#include "shapeid/fast/triangle.hpp"

namespace shapeid::fast {
namespace {

/// The link that column j belongs to; the first for a column of zeros.
int link_of(const MassProblem& problem, Eigen::Index j) {
  for (Eigen::Index i = 0; i < problem.U.rows(); ++i) {
    if (problem.U(i, j) != 0.0) return static_cast<int>(i / 10);
  }
  return 0;
}

[[maybe_unused]] Violation why_no_start(const MassProblem& problem, const Eigen::VectorXd& start) {
  if (start.size() != problem.shapes()) return "a start needs a mass for each shape";
  if (!start.allFinite() || (start.array() < 0.0).any()) {
    return "a mass of the start is negative or not finite";
  }
  return std::nullopt;
}

}  // namespace

Violation why_not_by_links(const MassProblem& problem) {
  if (problem.U.rows() % 10 != 0) {
    return std::to_string(problem.U.rows()) + " rows of U are not ten a link";
  }
  for (Eigen::Index j = 0; j < problem.shapes(); ++j) {
    const Eigen::Index first = Eigen::Index{10} * link_of(problem, j);
    const Eigen::VectorXd u = problem.U.col(j);
    if (!u.head(first).isZero(0.0) || !u.tail(u.size() - first - 10).isZero(0.0)) {
      return "column " + std::to_string(j) + " of U belongs to two links";
    }
  }
  return std::nullopt;
}

std::optional<MassSolution> solve_masses(const MassProblem& problem) {
  return solve_masses(problem, Eigen::VectorXd::Zero(problem.shapes()));
}

std::optional<MassSolution> solve_masses(const MassProblem& problem, const Eigen::VectorXd& start) {
  SHAPEID_CONTRACT(why_malformed(problem));
  SHAPEID_CONTRACT(why_not_by_links(problem));
  SHAPEID_CONTRACT(why_no_start(problem, start));
  Triangle triangle(problem.Y.cols());
  const Eigen::VectorXd root = problem.W.cwiseSqrt();
  const Eigen::MatrixXd Y = root.asDiagonal() * problem.Y;
  triangle.add(Y, root.cwiseProduct(problem.F));

  MassSolver solver(static_cast<int>(problem.U.rows() / 10), static_cast<int>(problem.shapes()));
  solver.set_lambda(problem.lambda);
  for (Eigen::Index j = 0; j < problem.shapes(); ++j) {
    const int link = link_of(problem, j);
    const MassSolver::Column u = problem.U.col(j).segment<10>(Eigen::Index{10} * link);
    if (!fits_in_single(u)) return std::nullopt;
    static_cast<void>(solver.append(link, u, problem.V[j]));
    if (start[j] > 0.0) solver.start_at(static_cast<int>(j), start[j]);
  }
  if (solver.solve(triangle.R()) != Outcome::solved) return std::nullopt;

  MassSolution solution;
  solution.m = solver.m();
  solution.Phi = solver.Phi();
  solution.value = solver.value();
  solution.active.assign(static_cast<std::size_t>(problem.shapes()), true);
  for (const int j : solver.passive()) solution.active[static_cast<std::size_t>(j)] = false;
  solution.iterations = solver.iterations();
  return solution;
}

}  // namespace shapeid::fast
