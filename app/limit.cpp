#include "shapeid/app/limit.hpp"

#include <vector>

#include "shapeid/models/inertia.hpp"
#include "shapeid/proofs/certificate/floor.hpp"
#include "shapeid/reference/mass_solver.hpp"

namespace shapeid::app {
namespace {

/// Columns and volumes of the shapes with mass, and one more for a point of the region.
MassProblem with_point(const MassProblem& p, const Eigen::VectorXd& m,
                       const certificate::Place& place) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index j = 0; j < m.size(); ++j) {
    if (m[j] > 0.0) kept.push_back(j);
  }
  MassProblem next = p;
  const auto n = static_cast<Eigen::Index>(kept.size());
  next.U.setZero(p.U.rows(), n + 1);
  next.U.leftCols(n) = p.U(Eigen::all, kept);
  next.U.col(n).segment<10>(10 * place.link) =
      from_centre(1.0, place.point, Eigen::Matrix3d::Zero()).values;
  next.V = Eigen::VectorXd::Ones(n + 1);  // no density term asks for them
  return next;
}

Eigen::VectorXd start(const Eigen::VectorXd& m) {
  Eigen::VectorXd masses = Eigen::VectorXd::Zero((m.array() > 0.0).count() + 1);
  Eigen::Index next = 0;
  for (const double mass : m) {
    if (mass > 0.0) masses[next++] = mass;
  }
  return masses;
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
    if (!floor->next || solution.value.data - highest <= options.gap * highest) break;
    p = with_point(p, solution.m, *floor->next);
    solution = reference::solve_masses(p, start(solution.m));
  }
  return best;
}

}  // namespace shapeid::app
