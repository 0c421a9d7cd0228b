// The exact optimum against all active sets, and how long it takes.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <chrono>

#include "shapeid/fast/solve_masses.hpp"
#include "shapeid/proofs/certificate/bound.hpp"
#include "shapeid/proofs/certificate/optimum.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/certificate/oracle.hpp"
#include "shapeid/tests/certificate/problems.hpp"

namespace shapeid::certificate {
namespace {

Eigen::VectorXd doubles(const std::vector<mpq_class>& v) {
  Eigen::VectorXd d(static_cast<Eigen::Index>(v.size()));
  for (Eigen::Index i = 0; i < d.size(); ++i) d[i] = v[static_cast<std::size_t>(i)].get_d();
  return d;
}

void optimum_is_the_oracles(bool zero_lambda) {
  const StatedProblem p = *test::small_problem(zero_lambda);
  // Dependent free columns leave the oracle without a unique point.
  RC_PRE(p.masses.F.size() >= p.others.values.cols());
  const test::ExactMinimum truth = test::minimum_of_all_active_sets(p);
  const auto proved = prove_optimum(p, {doubles(truth.m), doubles(truth.x)});
  RC_ASSERT(proved.has_value());
  RC_ASSERT(proved->same);
  RC_ASSERT(proved->value == truth.value);
  if (zero_lambda) return;  // then masses need not be unique
  for (std::size_t j = 0; j < truth.m.size(); ++j) RC_ASSERT(proved->m.at(j) == truth.m[j]);
  for (std::size_t k = 0; k < truth.x.size(); ++k) RC_ASSERT(proved->x.at(k) == truth.x[k]);
}

RC_GTEST_PROP(ExactOptimum, OfAllActiveSets, ()) { optimum_is_the_oracles(false); }
RC_GTEST_PROP(ExactOptimum, OfAllActiveSetsWithoutDensityTerm, ()) { optimum_is_the_oracles(true); }

/// A wrong free set never proves anything but the optimum.
RC_GTEST_PROP(ExactOptimum, FromAnyFreeSetTheOptimumOrNothing, ()) {
  const StatedProblem p = *test::small_problem(*rc::gen::arbitrary<bool>());
  RC_PRE(p.masses.F.size() >= p.others.values.cols());
  const auto drawn = *rc::gen::container<std::vector<double>>(
      static_cast<std::size_t>(p.masses.shapes()), rc::gen::element(0.0, 0.5, 2.0));
  const Eigen::VectorXd m = Eigen::Map<const Eigen::VectorXd>(drawn.data(), p.masses.shapes());
  const Eigen::VectorXd x = p.others.lower.cwiseMax(-1.0).cwiseMin(p.others.upper);
  const auto proved = prove_optimum(p, {m, x});
  if (proved) RC_ASSERT(proved->value == test::minimum_of_all_active_sets(p).value);
}

/// Of two shapes that the rows do not tell apart the heavy one moves: the light one, which rounding
/// has left, could not go down by as much.
TEST(ExactOptimum, WhatHasToMoveIsNotNearItsBound) {
  StatedProblem p = test::one_point_problem();
  p.masses.lambda = p.masses.mass_bound = 0.0;
  p.masses.U = Eigen::MatrixXd::Zero(10, 2);
  p.masses.U.row(0).setOnes();
  p.masses.V = Eigen::VectorXd::Ones(2);
  constexpr double left = 0x1p-60, off = 0x1p-50;
  for (const bool first : {true, false}) {
    const Eigen::Vector2d m(first ? 1.0 + off : left, first ? left : 1.0 + off);
    const auto proved = prove_optimum(p, {m, {}});
    ASSERT_TRUE(proved);
    EXPECT_TRUE(proved->same);
    EXPECT_EQ(proved->value, 0);
    EXPECT_EQ(proved->m.at(first ? 1 : 0), exact(left));
  }
}

TEST(ExactOptimum, OfALoadAsBothPathsFindIt) {
  const StatedProblem p = test::load_problem();
  const MassSolution reference = reference::solve_masses(p.masses);
  const auto proved = prove_optimum(p, {reference.m, {}});
  ASSERT_TRUE(proved);
  EXPECT_TRUE(proved->same);
  const auto fast = fast::solve_masses(p.masses);
  ASSERT_TRUE(fast);
  const auto again = prove_optimum(p, {fast->m, {}});
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->same);
  EXPECT_EQ(proved->value, again->value);
}

/// 130 rows, a thousand shapes: "about a second".
TEST(ExactOptimum, OfAThousandShapesOnThirteenLinks) {
  const StatedProblem p = test::body_problem(77);
  const auto solution = fast::solve_masses(p.masses);
  ASSERT_TRUE(solution);
  const auto start = std::chrono::steady_clock::now();
  const auto proved = prove_optimum(p, {solution->m, {}});
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  ASSERT_TRUE(proved);
  EXPECT_TRUE(proved->same);
  fmt::print("{} shapes, {} with mass: exact optimum in {:.2f} s, denominator of {} bits\n",
             p.masses.shapes(), (solution->m.array() > 0.0).count(), seconds.count(),
             mpz_sizeinbase(proved->m.denominator.get_mpz_t(), 2));
  EXPECT_LT((rounded_up(abs(proved->value - exact(solution->value.total())))),
            1e-9 * p.masses.F.squaredNorm());
}

}  // namespace
}  // namespace shapeid::certificate
