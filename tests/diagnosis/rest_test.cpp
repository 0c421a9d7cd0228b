// Joints that stand still: found, and left out of fits and errors, because friction at rest holds
// any torque.
#include <gtest/gtest.h>

#include <cmath>

#include "shapeid/diagnosis/rich_model.hpp"
#include "shapeid/diagnosis/series.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

using test::arm;
using test::arm_settings;
using test::record;

constexpr double recorded_rate = 100.0;  // Hz, of record()
constexpr int rested = 1;                // joint

/// A log of the arm that then holds joint `rested` still for two seconds while the others go on;
/// its torque there is `held`.
Recording with_rest(double held) {
  const Recording moving = record({});
  std::vector<Sample> samples = moving.samples();
  const std::size_t still = samples.size() - static_cast<std::size_t>(2.0 * recorded_rate);
  const double place = samples[still].q[rested];
  for (std::size_t i = still; i < samples.size(); ++i) {
    samples[i].q[rested] = place;
    samples[i].dq[rested] = 0.0;
    samples[i].ddq[rested] = 0.0;
    samples[i].tau[rested] = held;
  }
  return Recording(std::move(samples), recorded_rate);
}

TEST(Rest, IsFoundWhereAJointStandsStillAndNotWhereItTurnsRound) {
  const Recording log = with_rest(0.0);
  const std::size_t count = log.samples().size(), still = count - 200;
  std::size_t slow = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      const bool expected = j == rested && i >= still;
      ASSERT_EQ(log.at_rest(i, j), expected) << "sample " << i << ", joint " << j;
      if (!expected && std::abs(log[i].dq[j]) < 0.01) ++slow;
    }
  }
  EXPECT_GT(slow, 0U) << "a joint that turns round is slow for a moment, and counts";
}

TEST(Rest, ShortStopsCount) {
  std::vector<Sample> samples = record({}).samples();
  for (std::size_t i = 500; i < 520; ++i) samples[i].dq[0] = 0.0;
  const Recording log(std::move(samples), recorded_rate);
  for (std::size_t i = 500; i < 520; ++i) EXPECT_FALSE(log.at_rest(i, 0));
}

TEST(Rest, TorqueThatHoldsAJointStillChangesNoFitAndNoError) {
  const LoopSettings settings = arm_settings();
  const Recording one = with_rest(0.0), other = with_rest(40.0);
  const LoopResult a = close_loop(arm(), one, nullptr, settings);
  const LoopResult b = close_loop(arm(), other, nullptr, settings);
  EXPECT_EQ(a.model.Phi, b.model.Phi);
  EXPECT_EQ(test::found_ids(a), test::found_ids(b));
  EXPECT_EQ(series(arm(), settings.rows, a.model, one, 1).rms(),
            series(arm(), settings.rows, a.model, other, 1).rms());
}

TEST(Rest, WithContactsEveryRowCounts) {
  const Recording log = with_rest(0.0);
  const Robot robot = arm();
  const Viewer viewer(robot, ContactTreatment::ignore, {});
  const std::size_t index = log.samples().size() - 50;
  View view = viewer.view(log, index);
  EXPECT_FALSE(counted_rows(viewer, log, index, view)[rested]);
  view.J = Eigen::MatrixXd::Ones(3, 3);
  EXPECT_TRUE(counted_rows(viewer, log, index, view).all());
}

/// What is light for an arm is all that a toy's joint ever has.
TEST(LightLoad, IsATenthOfWhatASmallJointOftenHas) {
  std::vector<Sample> samples(100);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Sample& s = samples[i];
    s.time = 0.01 * static_cast<double>(i);
    s.q = s.dq = s.ddq = Eigen::Vector3d::Zero();
    s.tau = Eigen::Vector3d(0.05, -20.0, 0.0);
  }
  const Recording log(std::move(samples), 100.0);
  EXPECT_DOUBLE_EQ(light_load(log, 0), 0.005);
  EXPECT_DOUBLE_EQ(light_load(log, 1), 0.1);
  EXPECT_DOUBLE_EQ(light_load(log, 2), 0.1) << "of no torque nothing is known";
}

/// A wheel that turns far resolves its periods finely. (The grid once was never finer than a tenth
/// of a period a radian; then a wheel of 300 rad took a minute.)
class StrongestRipple : public testing::TestWithParam<double> {};

TEST_P(StrongestRipple, IsFoundOverManyTurns) {
  const double turns = GetParam();  // rad
  constexpr double N = 57.317;      // 1/rad
  std::vector<Sample> samples(2000);
  Series left;
  left.residual.setZero(3, std::ssize(samples));
  left.predicted.setOnes(3, std::ssize(samples));
  left.counted.setConstant(3, std::ssize(samples), true);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].time = 0.01 * static_cast<double>(i);
    const double part = static_cast<double>(i) / static_cast<double>(samples.size());
    // There and back at changing speed, so that readings are no comb.
    const double q = 0.5 * turns * (1.0 - std::cos(7.3 * part)) + 0.3 * std::sin(311.0 * part);
    samples[i].q = samples[i].dq = samples[i].ddq = samples[i].tau = Eigen::Vector3d(0.0, q, 0.0);
    left.index.push_back(i);
    left.residual(1, static_cast<Eigen::Index>(i)) = 0.2 + std::sin(N * q + 0.8);
  }
  const Recording log(std::move(samples), 100.0);
  const double found = strongest_ripple(arm(), log, left, 1, 1, RippleOf::torque, 4.0, 200.0);
  EXPECT_LT(std::abs(found - N), 0.5 / turns);
}

INSTANTIATE_TEST_SUITE_P(Turns, StrongestRipple, testing::Values(20.0, 100.0, 1500.0));

/// An hour without samples is no hour of data: blocks are made of what was recorded. (By the clock
/// a minute's log with such a pause had two blocks, and was refused as too short.)
TEST(Recording, ALongPauseIsNoData) {
  std::vector<Sample> samples(6);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].time = 8.0 + 0.01 * double(i) + (i < 4 ? 0.0 : 3600.0);
  }
  const Recording log(std::move(samples), 100.0);
  constexpr double rounding = 1e-9;  // s, of an hour
  EXPECT_NEAR(log.recorded(3), 0.03, rounding);
  EXPECT_NEAR(log.recorded(4), 2.03, rounding);
  EXPECT_NEAR(log.duration(), 2.04, rounding);
  EXPECT_NEAR(log.elapsed(5), 3600.05, rounding);
}

/// Parts of one log share its clock; blocks begin with the part.
TEST(Recording, PartsOfALogShareItsClock) {
  std::vector<Sample> samples(3);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].time = 8.0 + 0.01 * double(i);
  Recording part(std::move(samples), 100.0);
  constexpr double rounding = 1e-12;  // s
  EXPECT_NEAR(part.elapsed(2), 0.02, rounding) << "a log of its own, if nothing else is said";
  part.set_origin(3.0);
  EXPECT_NEAR(part.elapsed(2), 5.02, rounding);
  EXPECT_NEAR(part.surroundings(2).elapsed, 5.02, rounding);
  EXPECT_NEAR(part.recorded(2), 0.02, rounding);
  EXPECT_NEAR(part.duration(), 0.02, rounding);
}

}  // namespace
}  // namespace shapeid::diagnosis
