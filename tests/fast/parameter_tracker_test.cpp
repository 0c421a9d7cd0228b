// The square-root filter against the textbook's: gain and covariance written out.
#include "shapeid/fast/parameter_tracker.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/LU>

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
    tracker.measure(window, 1e-28);
    tracker.drift(0.02);
    ASSERT_TRUE(tracker.mean().allFinite()) << k;
    ASSERT_TRUE(tracker.covariance().allFinite()) << k;
  }
  EXPECT_NEAR(rows.row(0).head(n).dot(tracker.mean()), 7.0, 1e-6);
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
      tracker.drift(seconds);
      expected.P.diagonal() += seconds * wander.cwiseAbs2();
    }
    if (*rc::gen::inRange(0, 4) == 0) {
      tracker.loosen();
      expected.P.diagonal() += spread.cwiseAbs2();
    }
    const auto rows = *rc::gen::inRange<Index>(1, 12);
    MatrixXd Ab(rows, n + 1);
    for (Index i = 0; i <= n; ++i) Ab.col(i) = *test::vector(rows, 1.0);
    const double variance = *test::magnitude(0.01, 10.0);
    expected.measure(Ab.leftCols(n), Ab.col(n), variance);
    Triangle window(n);
    window.absorb(Ab);  // takes them apart
    tracker.measure(window, variance);

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
