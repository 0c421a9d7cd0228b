// The fast mass solver against planted minimisers and against the reference, on the problems that
// the reference is tested with.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "shapeid/fast/solve_masses.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::planted_problem;
using test::PlantedProblem;
using test::scaled;
using test::scaled_mass_difference;
using test::scaled_objective_difference;

/// The solver's own bound on a gradient entry over its terms.
constexpr double promised_slope = 1e-10;

/// Counts what was compared, how often the fast path declined, and how often an answer is right to
/// what it promises but not to a few hundred roundings. Both are rare (docs/agreement.md), and
/// bounded here.
struct Tally {
  const char* what;
  int compared = 0, declined = 0, rough = 0;
  explicit Tally(const char* name) : what(name) {}
  ~Tally() {
    fmt::print("{}: {} compared, {} of them roughly, {} declined\n", what, compared, rough,
               declined);
  }
  Tally(const Tally&) = delete;
  Tally& operator=(const Tally&) = delete;
  [[nodiscard]] bool is_rare(int count) const { return count <= 1 + compared / 1000; }
};

/// The same minimum; for lambda > 0 also the same minimiser, as exactly as the problem's own
/// gradient can tell in double.
void expect_right(const PlantedProblem& planted, Tally& tally) {
  const MassProblem& p = planted.problem;
  const std::optional<MassSolution> fast = fast::solve_masses(p);
  if (!fast) {
    RC_ASSERT(tally.is_rare(++tally.declined));
    return;
  }
  ++tally.compared;
  RC_ASSERT(!(fast->m.array() < 0.0).any());
  for (Eigen::Index j = 0; j < p.shapes(); ++j) {
    RC_ASSERT(fast->active[static_cast<std::size_t>(j)] == !(fast->m[j] > 0.0));
  }
  // What the solver checks of every answer before it gives it out, here from the rows themselves.
  RC_ASSERT(reference::kkt_residual(p, fast->m).worst() < promised_slope);
  const double terms = test::objective_terms(p, fast->m);
  const Eigen::Index size = p.F.size() + p.shapes();
  RC_ASSERT(scaled(std::abs(fast->value.total() - objective(p, fast->m).total()), terms, size) <
            few_hundred_eps);
  const double above = objective(p, fast->m).total() - objective(p, planted.m).total();
  RC_ASSERT(above <= promised_slope * std::max(terms, test::objective_terms(p, planted.m)));
  if (!(scaled_objective_difference(p, fast->m, planted.m) < few_hundred_eps)) {
    RC_ASSERT(tally.is_rare(++tally.rough));
    return;
  }
  if (p.lambda > 0.0) {
    RC_ASSERT(scaled_mass_difference(p, fast->m, reference::solve_masses(p).m) < few_hundred_eps);
  }
}

RC_GTEST_PROP(FastMasses, Random, ()) {
  static Tally tally("random");
  expect_right(*planted_problem({}), tally);
}

RC_GTEST_PROP(FastMasses, Degenerate, ()) {
  static Tally tally("degenerate");
  expect_right(*planted_problem({.degenerate = true}), tally);
}

RC_GTEST_PROP(FastMasses, NearParallel, ()) {
  static Tally tally("near parallel");
  expect_right(*planted_problem({.degenerate = true, .near_parallel = true}), tally);
}

RC_GTEST_PROP(FastMasses, BadlyScaled, ()) {
  static Tally tally("badly scaled");
  expect_right(*planted_problem({.degenerate = true, .badly_scaled = true}), tally);
}

RC_GTEST_PROP(FastMasses, WithoutDensityTerm, ()) {
  static Tally tally("lambda = 0");
  expect_right(*planted_problem({.zero_lambda = true, .degenerate = true, .near_parallel = true}),
               tally);
}

RC_GTEST_PROP(FastMasses, WithoutDensityTermBadlyScaled, ()) {
  static Tally tally("lambda = 0, badly scaled");
  expect_right(*planted_problem({.zero_lambda = true, .near_parallel = true, .badly_scaled = true}),
               tally);
}

}  // namespace
}  // namespace shapeid
