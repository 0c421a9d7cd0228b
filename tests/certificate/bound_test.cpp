// The bound is a bound: never above the optimum of all active sets, from any residual; and tight at
// the optimum.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <optional>

#include "shapeid/proofs/certificate/bound.hpp"
#include "shapeid/tests/certificate/oracle.hpp"
#include "shapeid/tests/certificate/problems.hpp"
#include "shapeid/tests/support/generators.hpp"

namespace shapeid::certificate {
namespace {

RC_GTEST_PROP(DualBound, NeverAboveTheOptimumWhateverTheAnswer, ()) {
  const StatedProblem stated = *test::small_problem(*rc::gen::arbitrary<bool>());
  RC_PRE(stated.masses.F.size() >= stated.others.values.cols());
  const test::ExactMinimum truth = test::minimum_of_all_active_sets(stated);
  const ExactProblem p(stated);
  const Vector Phi = exact(*test::vector(stated.masses.U.rows(), 2.0));
  const Vector x = exact(*test::vector(stated.others.values.cols(), 2.0));
  Rational M;  // any bound that the optimum keeps
  for (const mpq_class& mass : truth.m) M += mass;
  M *= exact(1.0 + *test::real(0.0, 1.0));
  const auto bound = lower_bound(p, p.residual(Phi, settled_columns(p, Phi, x)), M);
  RC_ASSERT(bound.has_value());
  RC_ASSERT(*bound <= truth.value);
}

RC_GTEST_PROP(DualBound, IsTheOptimumAtTheOptimum, ()) {
  const StatedProblem stated = *test::small_problem(*rc::gen::arbitrary<bool>());
  RC_PRE(stated.masses.F.size() >= stated.others.values.cols());
  const test::ExactMinimum truth = test::minimum_of_all_active_sets(stated);
  const ExactProblem p(stated);
  const Vector r = p.residual(p.U.times(truth.m), truth.x);
  RC_ASSERT(lower_bound(p, r, std::nullopt) == std::optional<Rational>(truth.value));
}

/// What settled_columns() promises, one by one.
RC_GTEST_PROP(DualBound, SettledColumnsHaveNoSlopeWithoutEnd, ()) {
  StatedProblem stated = *test::small_problem(*rc::gen::arbitrary<bool>());
  const Eigen::Index k = stated.others.values.cols();
  RC_PRE(k > 0 && stated.masses.F.size() >= k);
  const Eigen::VectorXd given = *test::vector(k, 2.0);
  for (Eigen::Index i = 0; i < k; ++i) {
    stated.others.lower[i] = *rc::gen::element(-HUGE_VAL, given[i] - 1.0, given[i]);
    stated.others.upper[i] = *rc::gen::element(HUGE_VAL, given[i] + 1.0, given[i]);
  }
  const ExactProblem p(stated);
  const Vector Phi = exact(*test::vector(stated.masses.U.rows(), 2.0)), before = exact(given);
  const Vector x = settled_columns(p, Phi, before);
  const Vector c = p.C.transposed_times(products(p.W, p.residual(Phi, x)));
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool ends_below = p.lower[i].has_value(), ends_above = p.upper[i].has_value();
    RC_ASSERT(ends_below || sgn(c[i]) <= 0);
    RC_ASSERT(ends_above || sgn(c[i]) >= 0);
    if (ends_below && ends_above) RC_ASSERT(x[i] == before[i]);
    const bool at_an_end =
        (ends_below && before[i] == *p.lower[i]) || (ends_above && before[i] == *p.upper[i]);
    if (!at_an_end && !(ends_below && ends_above)) RC_ASSERT(c[i] == 0);
    if (x[i] != before[i]) RC_ASSERT(c[i] == 0);
  }
}

/// The sum of 2 a t + lambda t^2 / V at drawn points of { t >= 0, sum t <= M }.
RC_GTEST_PROP(DualBound, JointMinimumIsBelowEveryPointAndReached, ()) {
  const auto n = *rc::gen::inRange<Eigen::Index>(1, 6);
  const Eigen::VectorXd a = *test::vector(n, 1.0), weights = (*test::vector(n, 1.0)).cwiseAbs();
  Eigen::VectorXd V(n);
  for (double& v : V) v = *test::magnitude(0.1, 10.0);
  const double lambda = *test::magnitude(0.01, 10.0), M = *test::magnitude(0.1, 10.0);
  const auto least = least_mass_terms(exact(a), exact(V), exact(lambda), exact(M));
  RC_ASSERT(least.has_value());
  const auto terms = [&](const Vector& t) {
    Rational value;
    for (std::size_t j = 0; j < t.size(); ++j) {
      const auto i = static_cast<Eigen::Index>(j);
      value += 2 * exact(a[i]) * t[j] + exact(lambda) * t[j] * t[j] / exact(V[i]);
    }
    return value;
  };
  Vector t = exact(weights);
  const Rational total = sum(t);
  for (Rational& mass : t) mass *= exact(M) / (total + 1);
  RC_ASSERT(*least <= terms(t));
  // Frank and Wolfe's steps toward single corners come near it.
  Vector best(t.size());
  for (int step = 0; step < 2000; ++step) {
    std::size_t steepest = 0;
    Rational lowest;
    for (std::size_t j = 0; j < best.size(); ++j) {
      const auto i = static_cast<Eigen::Index>(j);
      const Rational slope = exact(a[i]) + exact(lambda) * best[j] / exact(V[i]);
      if (slope < lowest) {
        lowest = slope;
        steepest = j;
      }
    }
    const Rational share = exact(2.0 / (step + 2.0));
    for (std::size_t j = 0; j < best.size(); ++j) {
      const Rational corner = sgn(lowest) < 0 && j == steepest ? exact(M) : Rational(0);
      // Rounded down: still feasible, and short.
      best[j] = exact(rounded_down(best[j] + share * (corner - best[j])));
    }
  }
  RC_ASSERT(*least <= terms(best));
  // Its rate is 2 L M^2 / (steps + 2), with L the largest curvature.
  const Rational slack = exact(4.0 * lambda / V.minCoeff() * M * M / 1000.0);
  RC_ASSERT(terms(best) - *least <= slack);
}

/// Without a declared bound, one is proved where the rows weigh the shapes, and it holds.
RC_GTEST_PROP(DualBound, ProvedMassBoundHolds, ()) {
  StatedProblem stated = *test::small_problem(false);
  stated.others = {};
  const ExactProblem p(stated);
  const MassBound bound = mass_bound(stated, p, p.data_term(p.F));
  RC_ASSERT(!bound.declared);
  RC_PRE(bound.M.has_value());
  const test::ExactMinimum truth = test::minimum_of_all_active_sets(stated);
  Rational total;
  for (const mpq_class& mass : truth.m) total += mass;
  RC_ASSERT(total <= *bound.M);
}

TEST(MassBound, IsProvedForALoadAndNearItsMass) {
  StatedProblem stated = test::load_problem();
  stated.masses.mass_bound = 0.0;
  const ExactProblem p(stated);
  // The truth weighs 1 kg; an answer whose residual is the noise proves little more.
  const MassBound bound = mass_bound(stated, p, p.data_term(p.F) * exact(1e-3));
  ASSERT_TRUE(bound.M);
  EXPECT_GT(*bound.M, 1);
  EXPECT_LT(*bound.M, 2);
}

}  // namespace
}  // namespace shapeid::certificate
