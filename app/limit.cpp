#include "shapeid/app/limit.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "shapeid/models/inertia.hpp"
#include "shapeid/proofs/certificate/floor.hpp"
#include "shapeid/proofs/certificate/quadric.hpp"
#include "shapeid/reference/mass_solver.hpp"

namespace shapeid::app {
namespace {

struct Place {
  Eigen::Index link = 0;
  Vector10 parameters;  ///< of a unit point mass there
};

/// Places where a point mass lowers the data term, at most one a region; and by how much a kilogram
/// does at the best of them, half the slope.
struct Search {
  std::vector<Place> places;
  double lowest = 0.0;
};

Search search(const StatedProblem& stated, const Eigen::VectorXd& Phi) {
  const MassProblem& p = stated.masses;
  const Eigen::VectorXd g = p.Y.transpose() * p.W.cwiseProduct(p.Y * Phi - p.F);
  Search found;
  for (const Region& region : stated.regions) {
    const Vector10 slope = g.segment<10>(10 * region.link);
    const certificate::Lowest lowest = certificate::lowest_in(
        certificate::cost_of_point(certificate::exact(Eigen::VectorXd(slope))), region.shape);
    if (sgn(lowest.value) >= 0) continue;
    const Eigen::Vector3d point(lowest.point[0].get_d(), lowest.point[1].get_d(),
                                lowest.point[2].get_d());
    found.places.push_back({region.link, from_centre(1.0, point, Eigen::Matrix3d::Zero()).values});
    found.lowest = std::min(found.lowest, lowest.value.get_d());
  }
  return found;
}

struct Columns {
  MassProblem problem;
  Eigen::VectorXd start;
};

/// The shapes with mass, and a point of unit mass at each place.
Columns with_points(const MassProblem& p, const Eigen::VectorXd& m,
                    const std::vector<Place>& places) {
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
    const Place& place = places[static_cast<std::size_t>(k - n)];
    next.problem.U.col(k).segment<10>(10 * place.link) = place.parameters;
  }
  next.problem.V = Eigen::VectorXd::Ones(all);  // no density term asks for them
  return next;
}

/// Where places between the present ones would still lower the data term by up to `lowest` a
/// kilogram, the floor loses that times the bound on the mass. Parameters at which every present
/// place costs a little more than that instead lose it times the mass that is there. They are the
/// optimum with one more row, which rewards mass that much.
Eigen::VectorXd with_mass_rewarded(const MassProblem& p, const MassSolution& solution,
                                   double lowest) {
  constexpr double more = 1.25;
  MassProblem rewarded = p;
  const Eigen::Index rows = p.Y.rows();
  rewarded.Y.conservativeResize(rows + 1, Eigen::NoChange);
  rewarded.Y.row(rows).setZero();
  for (Eigen::Index l = 0; l < p.Y.cols(); l += 10) rewarded.Y(rows, l) = 1.0;
  rewarded.F.conservativeResize(rows + 1);
  rewarded.F[rows] = p.mass_bound;
  rewarded.W.conservativeResize(rows + 1);
  // The row pulls by its weight times what is missing to the bound; of a mass near the bound, as if
  // a tenth were.
  const double missing = std::max(p.mass_bound - solution.m.sum(), 0.1 * p.mass_bound);
  rewarded.W[rows] = -more * lowest / missing;
  return reference::solve_masses(rewarded, solution.m).Phi;
}

}  // namespace

certificate::Guess limit_of_divisions(const StatedProblem& stated, const LimitOptions& options) {
  if (stated.regions.empty() || stated.others.values.cols() > 0) return {};
  Columns now{stated.masses, {}};
  now.problem.lambda = 0.0;
  MassSolution solution = reference::solve_masses(now.problem);
  certificate::Guess best{solution.Phi, {}};
  double least_loss = HUGE_VAL;
  for (int round = 0; round < options.most_rounds; ++round) {
    const Search found = search(stated, solution.Phi);
    const double loss = -2.0 * found.lowest * solution.m.sum();
    if (loss < least_loss) {
      least_loss = loss;
      best.parameters = stated.masses.mass_bound > 0.0 && found.lowest < 0.0
                            ? with_mass_rewarded(now.problem, solution, found.lowest)
                            : solution.Phi;
    }
    if (least_loss <= options.gap * solution.value.data) break;
    now = with_points(now.problem, solution.m, found.places);
    solution = reference::solve_masses(now.problem, now.start);
  }
  return best;
}

double floor_of_divisions(const BodyModel& undivided, const MassProblem& problem) {
  const StatedProblem stated{problem, {}, regions_of(undivided)};
  const certificate::Guess guess = limit_of_divisions(stated);
  const auto floor = certificate::floor_of_divisions(stated, guess.parameters, guess.others);
  return floor ? std::max(0.0, floor->get_d()) : 0.0;
}

}  // namespace shapeid::app
