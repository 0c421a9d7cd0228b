#include "shapeid/app/limit.hpp"

#include <vector>

#include "shapeid/models/inertia.hpp"
#include "shapeid/proofs/certificate/floor.hpp"
#include "shapeid/reference/mass_solver.hpp"

namespace shapeid::app {
namespace {

struct Columns {
  MassProblem problem;
  Eigen::VectorXd start;
};

/// The shapes with mass, and a point of unit mass at each place.
Columns with_points(const MassProblem& p, const Eigen::VectorXd& m,
                    const std::vector<certificate::Place>& places) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index j = 0; j < m.size(); ++j) {
    if (m[j] > 0.0) kept.push_back(j);
  }
  const auto n = static_cast<Eigen::Index>(kept.size());
  const Eigen::Index all = n + static_cast<Eigen::Index>(places.size());
  Columns next{p, Eigen::VectorXd::Zero(all)};
  next.start.head(n) = m(kept);
  next.problem.U.setZero(p.U.rows(), all);
  next.problem.U.leftCols(n) = p.U(Eigen::all, kept);
  for (Eigen::Index k = n; k < all; ++k) {
    const certificate::Place& place = places[static_cast<std::size_t>(k - n)];
    next.problem.U.col(k).segment<10>(10 * place.link) =
        from_centre(1.0, place.point, Eigen::Matrix3d::Zero()).values;
  }
  next.problem.V = Eigen::VectorXd::Ones(all);  // no density term asks for them
  return next;
}

}  // namespace

certificate::Limit limit_of_divisions(const StatedProblem& stated, const LimitOptions& options) {
  if (stated.regions.empty() || stated.others.values.cols() > 0) return {};
  MassProblem p = stated.masses;
  p.lambda = 0.0;
  MassSolution solution = reference::solve_masses(p);
  certificate::Limit best;
  double highest = -1.0;
  for (int round = 0; round < options.most_rounds; ++round) {
    const auto floor = certificate::floor_of_divisions(stated, solution.Phi, {});
    if (!floor) return {};
    if (floor->value.get_d() > highest) {
      highest = floor->value.get_d();
      best.parameters = solution.Phi;
    }
    if (floor->next.empty() || solution.value.data - highest <= options.gap * highest) break;
    Columns next = with_points(p, solution.m, floor->next);
    solution = reference::solve_masses(next.problem, next.start);
    p = std::move(next.problem);
  }
  return best;
}

}  // namespace shapeid::app
