#include "shapeid/models/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <span>

#include "shapeid/models/butterworth.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/log_writer.hpp"
#include "shapeid/models/sample_builder.hpp"
#include "shapeid/tests/motion/example.hpp"
#include "shapeid/tests/motion/scratch.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using test::chain;
using test::few_hundred_eps;
using test::message_of;
using test::read_motion;
using test::ReadMotion;
using test::regular_times;
using test::scaled_difference;
using test::Scratch;
using test::smooth_motion;
using test::write_log;

/// The largest difference of each kind of quantity between samples and the closed form at their
/// own times.
struct Errors {
  double q = 0.0, dq = 0.0, ddq = 0.0, tau = 0.0, omega = 0.0, alpha = 0.0, force = 0.0;
};

Errors errors(const Robot& robot, std::span<const Sample> samples, double late = 0.0) {
  Errors e;
  const auto worst = [](double& most, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    most = std::max(most, (a - b).cwiseAbs().maxCoeff());
  };
  for (const Sample& s : samples) {
    const Sample truth = smooth_motion(robot, s.time - late);
    worst(e.q, s.q, truth.q);
    worst(e.dq, s.dq, truth.dq);
    worst(e.ddq, s.ddq, truth.ddq);
    worst(e.tau, s.tau, truth.tau);
    worst(e.omega, s.base_angular_velocity, truth.base_angular_velocity);
    worst(e.alpha, s.base_angular_acceleration, truth.base_angular_acceleration);
    worst(e.force, s.base_specific_force, truth.base_specific_force);
  }
  return e;
}

// The motion stays below 1.7 Hz, where two passes of second order at 20 Hz take away
// 1 - |H|^2 < (1.7 / 20)^4 of every quantity (a little more by bilinear warping of the ratio).
constexpr double highest = 1.7;
double attenuation(const MotionOptions& o, double rate) {
  const Butterworth design(o.order, o.cutoff, rate);
  return 1.0 - std::pow(design.gain(highest), 2);
}

TEST(Motion, ZeroPhaseGivesTheMotionAndItsDerivatives) {
  const Robot robot = chain(4, Root::floating);
  const Scratch scratch;
  const auto path = scratch.path("a.csv.gz");
  write_log(path, robot, regular_times(100.0, 500.0, 10000),
            [&](double t) { return smooth_motion(robot, t); });
  const auto [samples, report] = read_motion(path, robot);
  EXPECT_TRUE(report.floating);
  EXPECT_EQ(report.gaps, 0u);
  EXPECT_EQ(report.rows, 10000u);
  EXPECT_EQ(report.samples + report.dropped_at_ends, 10000u);
  EXPECT_NEAR(report.rate, 500.0, 1e-6);  // of stamps near 100 s: one part in 1e9
  EXPECT_LT(report.dropped_at_ends, 150u);
  // Amplitudes: 0.6 in a position, times 2 pi 1.7 for each derivative.
  const double w = 2.0 * std::numbers::pi * highest, a = attenuation({}, 500.0);
  const std::span<const Sample> inner(samples.begin() + 500, samples.end() - 500);
  Errors e = errors(robot, inner);
  EXPECT_LT(e.q, 0.6 * a);
  EXPECT_LT(e.dq, 0.6 * w * a);
  EXPECT_LT(e.ddq, 0.6 * w * w * a);
  EXPECT_LT(e.tau, (6.0 + 1.8 * w * w) * a);
  EXPECT_LT(e.omega, 0.6 * a);
  EXPECT_LT(e.alpha, 0.6 * w * a);
  EXPECT_LT(e.force, 0.6 * a);
  // Near the ends a thousandth of the turned acceleration may be left, for half a cutoff period.
  const double turned = 1e-3 * 2.0 * 0.6 * w * w, half_period = 0.5 / MotionOptions{}.cutoff;
  e = errors(robot, samples);
  EXPECT_LT(e.ddq, 0.6 * w * w * a + turned);
  EXPECT_LT(e.dq, 0.6 * w * a + turned * half_period);
  EXPECT_LT(e.q, 0.6 * a + turned * half_period * half_period);
}

TEST(Motion, ExactDerivativesAreTakenAsTheyAre) {
  Robot robot = chain(3, Root::floating);
  robot.contacts.push_back({"l2", 3, ContactKind::point, Eigen::Isometry3d::Identity()});
  const Scratch scratch;
  const auto path = scratch.path("a.csv");
  const auto motion = [&](double t) {
    Sample s = smooth_motion(robot, t);
    s.in_contact = {t > 0.5};
    return s;
  };
  write_log(path, robot, {0.0, 0.1, 0.15, 0.9, 3.0}, motion);
  MotionOptions options;
  options.exact_derivatives = true;
  const auto [samples, report] = read_motion(path, robot, options);
  ASSERT_EQ(samples.size(), 5u);
  for (const Sample& s : samples) {
    const Sample truth = motion(s.time);
    EXPECT_EQ(s.q, truth.q);
    EXPECT_EQ(s.dq, truth.dq);
    EXPECT_EQ(s.ddq, truth.ddq);
    EXPECT_EQ(s.tau, truth.tau);
    EXPECT_EQ(s.base_angular_velocity, truth.base_angular_velocity);
    EXPECT_EQ(s.base_angular_acceleration, truth.base_angular_acceleration);
    EXPECT_EQ(s.base_specific_force, truth.base_specific_force);
    EXPECT_EQ(s.in_contact, truth.in_contact);
  }
}

TEST(Motion, CausalIsLateByTheStatedDelayInEveryChannel) {
  const Robot robot = chain(3, Root::floating);
  const Scratch scratch;
  const auto path = scratch.path("a.csv");
  write_log(path, robot, regular_times(0.0, 500.0, 6000),
            [&](double t) { return smooth_motion(robot, t); });
  MotionOptions options;
  options.smoothing = Smoothing::causal;
  const auto [samples, report] = read_motion(path, robot, options);
  EXPECT_GT(report.group_delay, 0.01);
  const std::span<const Sample> inner(samples.begin() + 500, samples.end());
  const Errors prompt = errors(robot, inner), shifted = errors(robot, inner, report.group_delay);
  // What is left after the shift is the delay's dispersion, of second order in 1.7 Hz / 20 Hz.
  const double left = std::pow(highest / options.cutoff, 2);
  EXPECT_LT(shifted.q, left * prompt.q);
  EXPECT_LT(shifted.dq, left * prompt.dq);
  EXPECT_LT(shifted.ddq, left * prompt.ddq);
  EXPECT_LT(shifted.tau, left * prompt.tau);
  EXPECT_LT(shifted.omega, left * prompt.omega);
  EXPECT_LT(shifted.alpha, left * prompt.alpha);
  EXPECT_LT(shifted.force, left * prompt.force);
}

}  // namespace
}  // namespace shapeid
