// The square-root filter against the textbook's: gain and covariance written out.
#include "shapeid/fast/parameter_tracker.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/LU>

#include <limits>

#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::fast {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Textbook {
  VectorXd x;
  MatrixXd P;

  void measure(const MatrixXd& A, const VectorXd& b, double variance) {
    const MatrixXd S = A * P * A.transpose() + variance * MatrixXd::Identity(A.rows(), A.rows());
    const MatrixXd K = P * A.transpose() * S.inverse();
    x += K * (b - A * x);
    P = ((MatrixXd::Identity(P.rows(), P.rows()) - K * A) * P).eval();
  }
};

/// What is known to more digits than a double has beside what is not known at all stays a number.
TEST(ParameterTracker, StaysANumberWhereOneIsKnownFarBetter) {
  constexpr Index n = 4;
  ParameterTracker tracker(VectorXd::Ones(n), VectorXd::Ones(n), VectorXd::Zero(n));
  MatrixXd rows(2, n + 1);
  rows << 1.0, 1.0, 1.0, 0.3, 7.0, 1.0, 1.0 + 1e-9, 1.0, -0.2, 5.0;
  for (int k = 0; k < 20; ++k) {
    Triangle window(n);
    MatrixXd taken = rows;
    window.absorb(taken);
    ASSERT_TRUE(tracker.measure(window, 1e-28));
    ASSERT_TRUE(tracker.drift(0.02));
    ASSERT_TRUE(tracker.mean().allFinite()) << k;
    ASSERT_TRUE(tracker.covariance().allFinite()) << k;
  }
  EXPECT_NEAR(rows.row(0).head(n).dot(tracker.mean()), 7.0, 1e-6);
}

/// Rows that would be no numbers: the belief stays as it was, to the bit, and goes on.
TEST(ParameterTracker, KeepsItsBeliefWhereNoOtherComesAbout) {
  constexpr Index n = 3;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  ParameterTracker tracker(VectorXd::Ones(n), VectorXd::Ones(n), VectorXd::Constant(n, 1e100));
  const MatrixXd before = tracker.rows().R();
  Triangle window(n);
  MatrixXd rows = MatrixXd::Identity(n, n + 1);
  window.absorb(rows);
  Triangle spoilt(n);
  rows = MatrixXd::Constant(1, n + 1, nan);
  spoilt.absorb(rows);
  EXPECT_FALSE(tracker.measure(spoilt, 1.0));
  EXPECT_FALSE(tracker.measure(window, 1e-300));  // squares beyond what a log may add up to
  EXPECT_FALSE(tracker.drift(1e200));             // a variance that is no number
  EXPECT_EQ(tracker.rows().R(), before);
  EXPECT_TRUE(tracker.loosen());
  EXPECT_TRUE(tracker.measure(window, 1.0));
  EXPECT_TRUE(tracker.mean().allFinite());
  EXPECT_TRUE(tracker.covariance().allFinite());
}

/// A variance that is a number, but none in units of the spread: rows of zeros would say nothing.
TEST(ParameterTracker, KeepsItsBeliefWhereItWandersBeyondAllSpreads) {
  ParameterTracker tracker(VectorXd::Zero(1), VectorXd::Constant(1, 1e-100),
                           VectorXd::Constant(1, 1e100));
  const MatrixXd before = tracker.rows().R();
  EXPECT_FALSE(tracker.drift(1.0));
  EXPECT_EQ(tracker.rows().R(), before);
  EXPECT_TRUE(tracker.covariance().allFinite());
}

RC_GTEST_PROP(ParameterTracker, EqualsTheTextbook, ()) {
  const auto n = *rc::gen::inRange<Index>(1, 8);
  const VectorXd start = *test::vector(n, 2.0);
  VectorXd spread(n), wander(n);
  for (Index i = 0; i < n; ++i) {
    spread[i] = *test::magnitude(0.1, 10.0);
    wander[i] = i % 3 == 2 ? 0.0 : *test::magnitude(0.01, 1.0);
  }
  ParameterTracker tracker(start, spread, wander);
  Textbook expected{start, spread.cwiseAbs2().asDiagonal()};
  const int steps = *rc::gen::inRange(1, 8);
  for (int k = 0; k < steps; ++k) {
    if (*rc::gen::arbitrary<bool>()) {
      const double seconds = *test::magnitude(0.01, 10.0);
      RC_ASSERT(tracker.drift(seconds));
      expected.P.diagonal() += seconds * wander.cwiseAbs2();
    }
    if (*rc::gen::inRange(0, 4) == 0) {
      RC_ASSERT(tracker.loosen());
      expected.P.diagonal() += spread.cwiseAbs2();
    }
    const auto rows = *rc::gen::inRange<Index>(1, 12);
    MatrixXd Ab(rows, n + 1);
    for (Index i = 0; i <= n; ++i) Ab.col(i) = *test::vector(rows, 1.0);
    const double variance = *test::magnitude(0.01, 10.0);
    expected.measure(Ab.leftCols(n), Ab.col(n), variance);
    Triangle window(n);
    window.absorb(Ab);  // takes them apart
    RC_ASSERT(tracker.measure(window, variance));

    // Condition of what is inverted on either way, from the spreads and variances above.
    constexpr double condition = 1e6;
    const double size = expected.x.norm() + start.norm() + spread.norm();
    RC_ASSERT(test::scaled((tracker.mean() - expected.x).norm(), condition * size, n) <
              test::few_hundred_eps);
    RC_ASSERT(test::scaled((tracker.covariance() - expected.P).norm(),
                           condition * spread.squaredNorm(), n) < test::few_hundred_eps);
    // Rows that a mass problem can be solved on: the inverse covariance, and the mean.
    const MatrixXd R = tracker.rows().R().topLeftCorner(n, n).triangularView<Eigen::Upper>();
    const MatrixXd one = R.transpose() * R * expected.P;
    RC_ASSERT(test::scaled((one - MatrixXd::Identity(n, n)).norm(), condition, n) <
              test::few_hundred_eps);
  }
}

}  // namespace
}  // namespace shapeid::fast
