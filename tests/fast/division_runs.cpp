#include "shapeid/tests/fast/division_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "shapeid/fast/division.hpp"
#include "shapeid/fast/triangle.hpp"
#include "shapeid/reference/division.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::test {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What is kept of a reference run after the first solve and after every division.
struct Snapshot {
  MassProblem problem;
  Eigen::VectorXd m, Phi, v;
  double value;
  std::string divided;  ///< next; empty at the end
};

std::vector<Snapshot> reference_run(const ModelWithRows& given, const DivisionOptions& options) {
  std::vector<Snapshot> snapshots;
  const auto watch = [&](const reference::DivisionRun& run) {
    if (!run.history.empty()) snapshots.back().divided = run.history.back().divided;
    snapshots.push_back({run.problem, run.solution.m, run.solution.Phi,
                         reference::division_criterion(run.model, run.solution.m, options),
                         run.solution.value.total(), ""});
  };
  static_cast<void>(reference::divide_and_solve(given.model, given.problem, options, watch));
  return snapshots;
}

Eigen::MatrixXd triangle_of(const MassProblem& problem) {
  fast::Triangle triangle(problem.Y.cols());
  const Eigen::VectorXd root = problem.W.cwiseSqrt();
  const Eigen::MatrixXd Y = root.asDiagonal() * problem.Y;
  triangle.add(Y, root.cwiseProduct(problem.F));
  return triangle.R();
}

/// v of every place from a fast run's masses, by the reference's formula.
double criterion(double m, double V, double V0, const DivisionOptions& options) {
  const double mass = m / options.expected_mass, size = V / V0;
  return options.k1 * mass * size + options.k2 * mass / size;
}

void compare(const fast::MassSolver& masses, const Snapshot& expected, double terms,
             RunComparison& result) {
  const Eigen::VectorXd m = masses.m();
  keep_worst(result.worst_objective, scaled(std::abs(masses.value().total() - expected.value),
                                            terms, expected.problem.F.size() + m.size()));
  if (m.size() > 0 && expected.m.maxCoeff() > 0.0) {
    keep_worst(result.worst_mass,
               (m - expected.m).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / expected.m.maxCoeff());
    keep_worst(result.worst_scaled_mass, scaled_mass_difference(expected.problem, m, expected.m));
  }
  keep_worst(result.worst_Phi,
             (masses.Phi() - expected.Phi).norm() / std::max(expected.Phi.norm(), 1e-300));
  const auto one_sided = (m.array() > 0.0) != (expected.m.array() > 0.0);
  result.other_side = std::max(result.other_side, static_cast<int>(one_sided.count()));
}

}  // namespace

RunComparison compare_runs(const ModelWithRows& given, int most_divisions) {
  const DivisionOptions options{
      .step = 0.0, .most_divisions = most_divisions, .expected_mass = given.expected_mass};
  RunComparison result;
  const Clock::time_point start = Clock::now();
  const std::vector<Snapshot> expected = reference_run(given, options);
  result.reference_seconds = seconds_since(start);
  const Eigen::MatrixXd R = triangle_of(given.problem);
  fast::Division run(given.model, options);
  run.set_lambda(given.problem.lambda);

  Clock::time_point before = Clock::now();
  result.declined = run.start(R) != fast::Outcome::solved;
  result.fast_seconds = seconds_since(before);
  const double V0 = given.problem.V.sum();
  const double terms = objective_terms(given.problem, expected[0].m);
  for (std::size_t k = 0; !result.declined; ++k) {
    const Snapshot& snapshot = expected[k];
    const Eigen::VectorXd m = run.masses().m();
    compare(run.masses(), snapshot, terms, result);

    std::vector<std::string> ids;
    ids.reserve(static_cast<std::size_t>(run.masses().shapes()));
    for (int place = 0; place < run.masses().shapes(); ++place) ids.push_back(run.id(place));
    const Eigen::VectorXd V = run.masses().V();
    before = Clock::now();
    const fast::Division::Step step = run.divide();
    result.fast_seconds += seconds_since(before);
    result.declined = step == fast::Division::Step::declined;
    const bool divided = step == fast::Division::Step::divided;
    if (!divided && snapshot.divided.empty()) break;
    const std::string chosen =
        divided ? ids[static_cast<std::size_t>(run.history().back().place)] : "";
    if (chosen != snapshot.divided && !result.declined) {
      const auto place_of = [&](const std::string& id) {
        return std::find(ids.begin(), ids.end(), id) - ids.begin();
      };
      if (chosen.empty() || snapshot.divided.empty()) {
        result.tie_at_difference = 1.0;  // one of them has nothing left to divide
      } else {
        const auto a = place_of(chosen), b = place_of(snapshot.divided);
        const double in_reference = std::abs(snapshot.v[a] - snapshot.v[b]) / snapshot.v.maxCoeff();
        const double va = criterion(m[a], V[a], V0, options);
        const double vb = criterion(m[b], V[b], V0, options);
        result.tie_at_difference = std::max(in_reference, std::abs(va - vb) / std::max(va, vb));
        result.v_apart_at_difference =
            std::max(std::abs(va - snapshot.v[a]), std::abs(vb - snapshot.v[b])) /
            std::min(std::max(va, vb), snapshot.v.maxCoeff());
      }
      result.first_difference = fmt::format(
          "division {}: fast cuts '{}', reference '{}', v apart by {:g}; {} shapes, {} "
          "rows, lambda {:g}",
          k + 1, chosen, snapshot.divided, *result.tie_at_difference, m.size(),
          given.problem.F.size(), given.problem.lambda);
      break;
    }
    if (!divided) break;
    ++result.divisions;
  }
  if (result.declined) {
    result.first_difference =
        fmt::format("declined after {} divisions: {} links, {} rows, {} shapes", result.divisions,
                    given.model.free_links.size(), given.problem.F.size(), run.masses().shapes());
  }
  return result;
}

}  // namespace shapeid::test
