// The mass solver against problems whose answer is known: planted minimisers, and every active set.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/support/enumerate.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::reference {
namespace {

using test::few_hundred_eps;
using test::planted_problem;
using test::PlantedProblem;
using test::scaled;
using test::scaled_mass_difference;
using test::scaled_objective_difference;

double scaled_kkt(const MassProblem& problem, const Eigen::VectorXd& m) {
  return scaled(kkt_residual(problem, m).worst(), 1.0, problem.F.size() + problem.shapes());
}

void expect_right(const PlantedProblem& planted) {
  const MassProblem& p = planted.problem;
  RC_ASSERT(!why_malformed(p));
  const MassSolution solution = solve_masses(p);
  RC_ASSERT(solution.m.allFinite());
  RC_ASSERT(!(solution.m.array() < 0.0).any());
  for (Eigen::Index j = 0; j < p.shapes(); ++j) {
    if (solution.active[static_cast<std::size_t>(j)]) RC_ASSERT(solution.m[j] == 0.0);
  }
  RC_ASSERT(scaled_kkt(p, solution.m) < few_hundred_eps);
  RC_ASSERT(scaled_objective_difference(p, solution.m, planted.m) < few_hundred_eps);
  const Eigen::VectorXd enumerated = test::best_of_all_active_sets(p);
  RC_ASSERT(scaled_objective_difference(p, solution.m, enumerated) < few_hundred_eps);
  if (p.lambda > 0.0) {
    RC_ASSERT(scaled_mass_difference(p, solution.m, planted.m) < few_hundred_eps);
  }
}

RC_GTEST_PROP(EveryActiveSet, Random, ()) { expect_right(*planted_problem({})); }

RC_GTEST_PROP(EveryActiveSet, Degenerate, ()) {
  expect_right(*planted_problem({.degenerate = true}));
}

RC_GTEST_PROP(EveryActiveSet, NearParallel, ()) {
  expect_right(*planted_problem({.degenerate = true, .near_parallel = true}));
}

RC_GTEST_PROP(EveryActiveSet, BadlyScaled, ()) {
  expect_right(*planted_problem({.degenerate = true, .badly_scaled = true}));
}

// m is then one of many: the planted masses must give the same f, not be the same.
RC_GTEST_PROP(EveryActiveSet, WithoutDensityTerm, ()) {
  expect_right(*planted_problem({.zero_lambda = true, .degenerate = true, .near_parallel = true}));
}

RC_GTEST_PROP(EveryActiveSet, WithoutDensityTermBadlyScaled, ()) {
  expect_right(
      *planted_problem({.zero_lambda = true, .near_parallel = true, .badly_scaled = true}));
}

// The planted problems themselves: their KKT conditions hold at the planted point.
RC_GTEST_PROP(EveryActiveSet, PlantedPointsAreOptimal, ()) {
  const PlantedProblem planted =
      *planted_problem({.degenerate = true, .near_parallel = true, .badly_scaled = true});
  RC_ASSERT(scaled_kkt(planted.problem, planted.m) < few_hundred_eps);
  RC_ASSERT((planted.m.array() * planted.z.array()).isZero(0.0));
}

}  // namespace
}  // namespace shapeid::reference
