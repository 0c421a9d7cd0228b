// What a drive that filters its torque reports, and what is predicted of it.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/loop.hpp"
#include "shapeid/diagnosis/rich_model.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr double log_rate = 500.0, turn = 9.0;  // Hz, rad/s

/// Only the last joint moves, evenly, about a level axis: its load is its link's weight, of one
/// frequency, and what a filter makes of it is known.
Recording turning() {
  std::vector<Sample> samples(500);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Sample& s = samples[i];
    s.time = static_cast<double>(i) / log_rate;
    s.q = Eigen::Vector3d(0.3, 0.8, turn * s.time);
    s.dq = Eigen::Vector3d(0.0, 0.0, turn);
    s.ddq = s.tau = Eigen::Vector3d::Zero();
  }
  return {std::move(samples), log_rate};
}

constexpr int last_joint = 2;

double predicted(const Recording& log, const std::vector<AppliedEffect>& effects, std::size_t i) {
  const Robot robot = test::arm();
  const Viewer viewer(robot, ContactTreatment::ignore, effects);
  return predict(viewer, viewer.view(log, i), {stacked_parameters(robot), effects})
      .force[last_joint];
}

/// What is left is of fourth order in T. The rate of now would leave the second.
TEST(TorqueLag, IsThatOfAFilterToThirdOrder) {
  const Recording log = turning();
  // The load is c cos(w t) + s sin(w t).
  const std::size_t first = 120, second = 190;
  Eigen::Matrix2d waves;
  Eigen::Vector2d loads;
  for (const std::size_t i : {first, second}) {
    const Eigen::Index row = i == first ? 0 : 1;
    waves.row(row) << std::cos(turn * log[i].time), std::sin(turn * log[i].time);
    loads[row] = predicted(log, {}, i);
  }
  const Eigen::Vector2d wave = waves.inverse() * loads;
  const std::complex<double> size(wave[0], -wave[1]);
  ASSERT_GT(std::abs(size), 0.5);
  ASSERT_NEAR(predicted(log, {}, 250), (size * std::polar(1.0, turn * log[250].time)).real(),
              1e-12 * std::abs(size));
  for (const double T : {0.0120, 0.0140}) {
    const std::vector<AppliedEffect> lag = {test::effect("torque_lag", last_joint, {T})};
    const std::complex<double> x(0.0, turn * T);
    double largest = 0.0;
    for (std::size_t i = 60; i < 440; ++i) {
      const std::complex<double> passed = size * std::polar(1.0, turn * log[i].time) / (1.0 + x);
      largest = std::max(largest, std::abs(predicted(log, lag, i) - passed.real()));
    }
    // (1 - 2/3) x^4, and of the orders that follow no more than 3 |x| of it.
    const double fourth = std::abs(size) * std::pow(std::abs(x), 4) / 3.0;
    EXPECT_LT(largest, fourth * (1.0 + 3.0 * std::abs(x))) << T;
    EXPECT_GT(largest, 0.5 * fourth) << "a bound that says something";
  }
}

/// The middle is a time constant ago and the span that of the filter, where the log is looked at
/// far enough; never further than a delay leaves, and never over less than the noise of motion
/// allows.
RC_GTEST_PROP(TorqueLag, LooksNoFurtherThanADelayLeaves, ()) {
  Robot robot = test::arm();
  robot.root = *rc::gen::element(Root::fixed, Root::floating);
  const double T = 1e-4 * *rc::gen::inRange(0, 501);
  const double of_torque = 1e-3 * *rc::gen::inRange(-18, 19);
  const bool has_imu = robot.root == Root::floating;
  const double of_imu = has_imu ? 1e-3 * *rc::gen::inRange(-18, 19) : 0.0;
  const double d = std::abs(of_torque) + std::abs(of_imu);
  const std::vector<AppliedEffect> effects = {test::effect("torque_lag", 1, {T}),
                                              test::effect("imu_delay", 0, {of_imu}),
                                              test::effect("torque_delay", 0, {of_torque})};
  const std::vector<LoadRate> rates = load_rates(robot, effects, {});
  RC_ASSERT(rates.size() == 1U);
  const LoadRate over = rates.front();
  RC_ASSERT(over.joint == 1);
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * largest_shift;
  const double step = neighbour_step(robot), half = std::sqrt(3.0) * T;
  RC_ASSERT(d + std::max(-over.begin, over.end) <= largest_shift + rounding);
  RC_ASSERT(over.span() >= 2.0 * step - rounding);
  if (half >= step && d + T + half <= largest_shift) {
    RC_ASSERT(std::abs(over.begin + T + half) <= rounding);
    RC_ASSERT(std::abs(over.end + T - half) <= rounding);
  }
}

/// One for each lag; for what is tried beside them that of all other joints comes first.
TEST(TorqueLag, HasASlopeOfItsOwn) {
  const Robot robot = test::arm();
  const std::vector<AppliedEffect> lags = {test::effect("torque_lag", 2, {0.018}),
                                           test::effect("viscous_friction", 0, {0.1}),
                                           test::effect("torque_lag", 0, {0.0})};
  const Viewer alone(robot, ContactTreatment::ignore, lags);
  ASSERT_EQ(alone.load_rates().size(), 2U);
  EXPECT_EQ(alone.load_rates()[0].joint, 0);
  EXPECT_EQ(alone.load_rates()[1].joint, 2);
  EXPECT_DOUBLE_EQ(alone.load_rates()[0].begin, -neighbour_step(robot));
  const Viewer beside(robot, ContactTreatment::ignore, lags, {test::effect("torque_lag", 1, {0})});
  ASSERT_EQ(beside.load_rates().size(), 3U);
  EXPECT_EQ(beside.load_rates()[0].joint, LoadRate::all_joints);
  EXPECT_DOUBLE_EQ(beside.load_rates()[0].end, neighbour_step(robot));
  EXPECT_TRUE(Viewer(robot, ContactTreatment::ignore, {}, {test::effect("torque_gain", 1, {0})})
                  .load_rates()
                  .empty());

  const Recording log = test::record({});
  const RichModel model{stacked_parameters(robot), lags};
  const Eigen::VectorXd of_two = predict(alone, alone.view(log, 200), model).load.rate;
  const Eigen::VectorXd of_all = predict(beside, beside.view(log, 200), model).load.rate;
  EXPECT_EQ(of_two[1], 0.0) << "nobody asks";
  EXPECT_NE(of_all[1], 0.0);
  EXPECT_EQ(of_all[0], of_two[0]);
  EXPECT_EQ(of_all[2], of_two[2]);
}

/// A drive that filters more than when the reference log was made is one filter.
TEST(TorqueLag, OfTwoTimesHasTheSlopeOfTheirSum) {
  const Robot robot = test::arm();
  AppliedEffect more = test::effect("torque_lag", 2, {0.005});
  more.when = When::since_reference;
  const std::vector<LoadRate> two =
      load_rates(robot, {test::effect("torque_lag", 2, {0.009}), more}, {});
  const std::vector<LoadRate> one = load_rates(robot, {test::effect("torque_lag", 2, {0.014})}, {});
  ASSERT_EQ(two.size(), 1U);
  EXPECT_DOUBLE_EQ(two[0].begin, one[0].begin);
  EXPECT_DOUBLE_EQ(two[0].end, one[0].end);
}

/// As while causes are sought: whatever its time constant.
TEST(TorqueLag, ToFirstOrderHasTheRateOfNow) {
  AppliedEffect lag = test::effect("torque_lag", 2, {0.018});
  lag.to_first_order = true;
  for (const Root root : {Root::fixed, Root::floating}) {
    Robot robot = test::arm();
    robot.root = root;
    const std::vector<LoadRate> rates = load_rates(robot, {lag}, {});
    ASSERT_EQ(rates.size(), 1U);
    EXPECT_EQ(rates[0].joint, LoadRate::all_joints);
    EXPECT_DOUBLE_EQ(rates[0].begin, -neighbour_step(robot));
    EXPECT_DOUBLE_EQ(rates[0].end, neighbour_step(robot));
  }
}

/// The arm's motion many times as fast, with joint 2's torque as a filter of first order with the
/// time constant T reports it.
Recording fast_with_filtered_torque(double times, double T) {
  test::ArmLog slow;
  slow.seconds = 12.0 * times;
  const Recording log = test::record(slow);
  const double rate = times * log.rate();
  std::vector<Sample> samples = log.samples();
  for (Sample& s : samples) {
    s.time /= times;
    s.dq *= times;
    s.ddq *= times * times;
  }
  const Robot robot = test::arm();
  const Viewer rigid(robot, ContactTreatment::ignore, {});
  const RichModel truth{stacked_parameters(robot), {}};
  std::mt19937 generator(1);
  std::normal_distribution<double> noise(0.0, 0.02);
  const double kept = std::exp(-1.0 / (rate * T));
  double before = 0.0, reported = 0.0;
  for (Sample& s : samples) {
    s.tau = predict(rigid, rigid.view(s, {}), truth).force;
    // Between two samples the torque changes steadily.
    const double now = s.tau[1], slope = (now - before) * rate;
    reported = now - slope * T + (reported - before + slope * T) * kept;
    before = now;
    s.tau[1] = reported;
    for (double& tau : s.tau) tau += noise(generator);
  }
  const auto settled = static_cast<std::ptrdiff_t>(std::ceil(20.0 * T * rate));
  samples.erase(samples.begin(), samples.begin() + settled);
  return {std::move(samples), rate};
}

/// With the law of first order to the end these logs have a gain of the next joint as well (0.9 %,
/// by four standard errors); and a gain of -1.3 % and a force of -1.1 N, by nine and six.
TEST(TorqueLag, OfAFilterIsFoundAlone) {
  struct Case {
    double times, T;
  };
  for (const Case& c : {Case{4.0, 0.010}, Case{8.0, 0.004}}) {
    const LoopResult result = close_loop(test::arm(), fast_with_filtered_torque(c.times, c.T),
                                         nullptr, test::arm_settings());
    ASSERT_EQ(test::found_ids(result), std::vector<std::string>{"torque_lag@joint2"});
    EXPECT_FALSE(result.found[0].effect.to_first_order);
    // Up to 29 rad/s over 20 ms to either side: a slope is short by a twentieth.
    EXPECT_NEAR(result.found[0].effect.value[0], c.T, 0.05 * c.T);
  }
}

}  // namespace
}  // namespace shapeid::diagnosis
