// By how much, and how surely, one fit's error is less than another's.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "shapeid/diagnosis/fits.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::diagnosis {
namespace {

using test::few_hundred_eps;
using test::scaled;

void expect_error(const Eigen::VectorXd& values, double squared) {
  const double error = sum_with_error(values).error;
  EXPECT_LT(scaled(std::abs(error * error - squared), values.squaredNorm(), values.size()),
            few_hundred_eps)
      << values.transpose();
}

/// Deviations 1, 1, -2: squares 6, neighbours 1 - 2 < 0, and next ones -2 < 0: no correlation.
/// (Of n independent values the variance of the sum is n / (n - 1) times the squares.)
TEST(SumWithError, OfWhatIsNotCorrelated) {
  const Eigen::Vector3d values(4.0, 4.0, 1.0);
  EXPECT_EQ(sum_with_error(values).sum, 9.0);
  expect_error(values, 6.0 * 3.0 / 2.0);
}

/// Deviations 3, 2, 1, -1, -2, -3: squares 28, neighbours 6 + 2 - 1 + 2 + 6 = 15, the next ones
/// 3 - 2 - 2 + 3 = 2, those three apart are not asked; weights 2/3 and 1/3, twice each.
TEST(SumWithError, OfWhatItsTwoNeighboursAreLike) {
  Eigen::VectorXd values(6);
  values << 3.0, 2.0, 1.0, -1.0, -2.0, -3.0;
  expect_error(values.array() + 10.0, (28.0 + 2.0 * (2.0 / 3.0 * 15.0 + 1.0 / 3.0 * 2.0)) * 1.2);
}

/// Deviations 1, -2, 1, -2, 1, 1: neighbours -7 count for nothing, the next ones 1 + 4 + 1 - 2 = 4.
TEST(SumWithError, OfWhatAlternatesIsNotSurer) {
  Eigen::VectorXd values(6);
  values << 2.0, -1.0, 2.0, -1.0, 2.0, 2.0;
  expect_error(values, (12.0 + 2.0 / 3.0 * 4.0) * 1.2);
}

/// Of three values the first and the last are neighbours' neighbours: 2 x 1/3 x 4, and none else.
TEST(SumWithError, OfThree) {
  const Eigen::Vector3d values(2.0, -4.0, 2.0);
  expect_error(values, (24.0 + 2.0 / 3.0 * 4.0) * 1.5);
}

TEST(SumWithError, OfOneIsNotKnown) {
  const SumWithError one = sum_with_error(Eigen::VectorXd::Constant(1, 3.0));
  EXPECT_EQ(one.sum, 3.0);
  EXPECT_EQ(one.error, std::numeric_limits<double>::infinity());
  EXPECT_EQ(one.t(), 0.0);
  EXPECT_EQ(sum_with_error(Eigen::VectorXd(0)).t(), 0.0);
  const SumWithError two = sum_with_error(Eigen::Vector2d(1.0, 3.0));
  EXPECT_EQ(two.error, 2.0) << "deviations -1 and 1, their product not counted";
  EXPECT_EQ(two.t(), 2.0);
}

/// Sure in every way: a change that is the same everywhere has no error to be judged by.
TEST(Gain, WithoutAnyErrorIsNoEvidence) {
  const Gain gain = gain_of(Eigen::Vector3d(2.0, 2.0, 2.0), Eigen::Vector3d(1.0, 1.0, 1.0));
  EXPECT_EQ(gain.share, 0.5);
  EXPECT_EQ(gain.t, 0.0);
}

/// One violent block drowns the differences 1, 2, 1, 300; relative to each block's error they are
/// 1/3, 1/2, 1/5 and 3/7.
TEST(Gain, IsAsSureAsItIsRelativeToEachBlock) {
  const Eigen::Vector4d before(2.0, 3.0, 3.0, 500.0), after(1.0, 1.0, 2.0, 200.0);
  const Gain gain = gain_of(before, after);
  EXPECT_EQ(gain.share, 304.0 / 508.0);
  const Eigen::Vector4d relative(1.0 / 3.0, 0.5, 0.2, 3.0 / 7.0);
  EXPECT_EQ(gain.t, sum_with_error(relative).t());
  EXPECT_GT(gain.t, 2.0 * sum_with_error(before - after).t());
}

/// The other way round small blocks get worse by much of themselves: what the large ones gain
/// counts.
TEST(Gain, IsAsSureAsItIsOfTheWhole) {
  const Eigen::Vector4d before(300.0, 310.0, 1.0, 290.0), after(200.0, 205.0, 3.0, 195.0);
  const Gain gain = gain_of(before, after);
  EXPECT_EQ(gain.t, sum_with_error(before - after).t());
  EXPECT_GT(gain.t, 0.0);
}

TEST(Gain, ABlockThatBothFitExactlyTellsNothing) {
  const Gain gain =
      gain_of(Eigen::Vector4d(4.0, 0.0, 5.0, 0.0), Eigen::Vector4d(3.0, 0.0, 3.0, 0.0));
  EXPECT_EQ(gain.share, 3.0 / 9.0);
  EXPECT_TRUE(std::isfinite(gain.t));
  EXPECT_GT(gain.t, 0.0);
}

RC_GTEST_PROP(Gain, SwappedChangesItsSign, ()) {
  const auto n = *rc::gen::inRange<Eigen::Index>(2, 20);
  Eigen::VectorXd one(n), other(n);
  for (Eigen::VectorXd* errors : {&one, &other}) {
    for (double& error : *errors) error = 0.01 * *rc::gen::inRange(1, 1000);
  }
  const Gain there = gain_of(one, other), back = gain_of(other, one);
  // The surer of two ways to ask: of a loss it is the less sure one.
  RC_ASSERT(there.t >= -back.t);
  const double off = std::abs(there.share * one.sum() - (one - other).sum());
  RC_ASSERT(scaled(off, one.sum(), n) < few_hundred_eps);
  RC_ASSERT(gain_of(8.0 * one, 8.0 * other).t == there.t);  // the unit does not matter
}

/// Two fits with 10 numbers' freedom left, whose error goes from 30 to 20: 10 over 2 a number.
TEST(Gain, InSquaresOfIndependentNoise) {
  Fit before, after;
  before.left = 30.0;
  after.left = 20.0;
  after.freedom = 10.0;
  EXPECT_EQ(squares_sum(before, after), 5.0);
  after.left = 0.0;
  EXPECT_EQ(squares_sum(before, after), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace shapeid::diagnosis
