#include "shapeid/models/motion.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "shapeid/models/butterworth.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/log_writer.hpp"
#include "shapeid/models/sample_builder.hpp"
#include "shapeid/tests/motion/example.hpp"
#include "shapeid/tests/motion/message_of.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::chain;
using test::few_hundred_eps;
using test::keep_worst;
using test::message_of;
using test::read_motion;
using test::ReadMotion;
using test::regular_times;
using test::scaled;
using test::scaled_difference;
using test::ScratchFolder;
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
    keep_worst(most, (a - b).cwiseAbs().maxCoeff<Eigen::PropagateNaN>());
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
  const ScratchFolder scratch;
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
  const ScratchFolder scratch;
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

// No derivative of a joint can be missing where there is no joint.
TEST(Motion, ABodyWithoutJointsHasItsExactDerivatives) {
  for (const Root root : {Root::fixed, Root::floating}) {
    const Robot robot = chain(0, root);
    const ScratchFolder scratch;
    const auto path = scratch.path("a.csv");
    write_log(path, robot, {0.0, 0.1, 0.2}, [&](double t) { return smooth_motion(robot, t); });
    MotionOptions options;
    options.exact_derivatives = true;
    EXPECT_EQ(read_motion(path, robot, options).samples.size(), 3u);
  }
}

TEST(Motion, CausalIsLateByTheStatedDelayInEveryChannel) {
  const Robot robot = chain(3, Root::floating);
  const ScratchFolder scratch;
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

TEST(Motion, WithoutSmoothingValuesAreThoseLogged) {
  const Robot robot = chain(2, Root::fixed);
  const ScratchFolder scratch;
  const auto path = scratch.path("a.csv");
  write_log(path, robot, regular_times(0.0, 500.0, 2000),
            [&](double t) { return smooth_motion(robot, t); });
  MotionOptions options;
  options.smoothing = Smoothing::none;
  const auto [samples, report] = read_motion(path, robot, options);
  ASSERT_GE(samples.size(), 1995u);  // two rows a side, and perhaps the last
  ASSERT_EQ(report.notes.size(), 1U);
  EXPECT_NE(report.notes.front().find("nothing is smoothed"), std::string::npos);
  // h^4 / 30 and h^4 / 90 of the fifth and sixth derivative, plus roundings of q over h^2
  const double w = 2.0 * std::numbers::pi * highest, h = 0.002;
  const Errors e = errors(robot, samples);
  EXPECT_LT(scaled(e.q, 0.6 + 0.6 * w * 10.0, 10), few_hundred_eps);
  EXPECT_LT(scaled(e.tau, 6.0 + 1.8 * w * w * w * 10.0, 10), few_hundred_eps);
  EXPECT_LT(e.dq, 0.6 * std::pow(w * h, 4) * w / 30.0);
  EXPECT_LT(e.ddq, 0.6 * std::pow(w * h, 4) * w * w / 90.0 + 1e3 * 2.2e-16 / (h * h));
}

TEST(Motion, SaysWhatCouldNotBeChecked) {
  const ScratchFolder scratch;
  std::string text = "time,q.j0,tau.j0,temperature.j0\n";
  for (int k = 0; k < 500; ++k) text += fmt::format("{},{},1,20\n", 0.002 * k, 0.001 * k);
  MotionOptions options;
  options.refuse_frozen = false;
  const auto path = scratch.write("a.csv", text);
  const MotionReport report = read_motion(path, chain(1, Root::fixed), options).report;
  EXPECT_EQ(report.extra, std::vector<std::string>{"temperature.j0"});
  EXPECT_EQ(report.notes, std::vector<std::string>{
                              "no dq.* columns: units of q and time are not checked by slopes"});
}

TEST(Motion, OtherColumnsComeAlongFromTheNearestRow) {
  const ScratchFolder scratch;
  std::string text = "time,q.j0,tau.j0,temperature.j0\n";
  // The row at 0.4 s has no temperature, the others have the row's number.
  for (int k = 0; k < 500; ++k) {
    text += fmt::format("{},{},{},{}\n", 0.002 * k, 0.001 * k, 0.1 * k,
                        k == 200 ? "" : std::to_string(k));
  }
  MotionOptions options;
  for (const bool exact : {false, true}) {
    options.smoothing = exact ? Smoothing::none : Smoothing::zero_phase;
    const auto samples =
        read_motion(scratch.write("a.csv", text), chain(1, Root::fixed), options).samples;
    ASSERT_FALSE(samples.empty());
    for (const Sample& s : samples) {
      ASSERT_EQ(s.extra.size(), 1U);
      const double row = std::round(s.time / 0.002);
      EXPECT_TRUE(row == 200.0 ? std::isnan(s.extra[0]) : s.extra[0] == row) << s.time;
    }
  }
}

TEST(Motion, LoggedVelocityIsUsedWhenTrusted) {
  const Robot robot = chain(2, Root::fixed);
  const ScratchFolder scratch;
  const auto path = scratch.path("a.csv");
  // 10 percent off: below what is refused, and easy to tell from the derivative.
  write_log(path, robot, regular_times(0.0, 500.0, 4000), [&](double t) {
    Sample s = smooth_motion(robot, t);
    s.dq *= 1.1;
    return s;
  });
  MotionOptions options;
  options.use_logged_velocity = true;
  const ReadMotion motion = read_motion(path, robot, options);
  ASSERT_GT(motion.samples.size(), 3500u);
  for (const Sample& s : motion.samples) {
    const Sample truth = smooth_motion(robot, s.time);
    EXPECT_LT((s.dq - 1.1 * truth.dq).norm(), 0.01);
    EXPECT_LT((s.ddq - 1.1 * truth.ddq).norm(), 0.2);
  }
}

// The IMU sits turned and off the base origin: what it reads there is rigid-body kinematics.
class ImuPose : public testing::Test {
 protected:
  ImuPose() : robot_(chain(2, Root::floating)) {
    notes_.imu.linear() = Eigen::Quaterniond(0.5, -0.7, 0.3, 0.9).normalized().toRotationMatrix();
    notes_.imu.translation() = Eigen::Vector3d(0.12, -0.07, 0.2);
  }

  [[nodiscard]] Sample seen_by_imu(Sample s) const {
    const Eigen::Vector3d r = notes_.imu.translation();
    const Eigen::Vector3d omega = s.base_angular_velocity, alpha = s.base_angular_acceleration;
    const Eigen::Matrix3d into_imu = notes_.imu.linear().transpose();
    s.base_specific_force =
        into_imu * (s.base_specific_force + alpha.cross(r) + omega.cross(omega.cross(r)));
    s.base_angular_velocity = into_imu * omega;
    s.base_angular_acceleration = into_imu * alpha;
    return s;
  }

  std::string write() {
    auto path = scratch_.path("a.csv");
    write_log(path, robot_, regular_times(0.0, 500.0, 4000),
              [&](double t) { return seen_by_imu(smooth_motion(robot_, t)); });
    return path;
  }

  Robot robot_;
  RobotNotes notes_;
  ScratchFolder scratch_;
};

TEST_F(ImuPose, ExactRowsComeBackInTheBaseFrame) {
  MotionOptions options;
  options.exact_derivatives = true;
  const ReadMotion motion = read_motion(write(), robot_, options, {}, notes_);
  ASSERT_EQ(motion.samples.size(), 4000u);
  for (const Sample& s : motion.samples) {
    const Sample truth = smooth_motion(robot_, s.time);
    EXPECT_LT(scaled_difference(s.base_angular_velocity, truth.base_angular_velocity, 3),
              few_hundred_eps);
    EXPECT_LT(scaled_difference(s.base_angular_acceleration, truth.base_angular_acceleration, 3),
              few_hundred_eps);
    EXPECT_LT(scaled_difference(s.base_specific_force, truth.base_specific_force, 3),
              few_hundred_eps);
  }
}

TEST_F(ImuPose, SmoothedRowsComeBackInTheBaseFrame) {
  const ReadMotion motion = read_motion(write(), robot_, {}, {}, notes_);
  const std::span<const Sample> inner(motion.samples.begin() + 500, motion.samples.end() - 500);
  const Errors e = errors(robot_, inner);
  // omega x (omega x r) doubles the frequency: 16 times the attenuation of its part.
  const double w = 2.0 * std::numbers::pi * highest, a = attenuation({}, 500.0), reach = 0.25;
  EXPECT_LT(e.omega, 2.0 * 0.6 * a);
  EXPECT_LT(e.alpha, 2.0 * 0.6 * w * a);
  EXPECT_LT(e.force, 2.0 * (0.6 + reach * 0.6 * w) * a + 16.0 * a * reach * 3.0 * 0.36);
}

/// Its stamps are whole numbers of 0.24 us, of which the median step is one: a grid of such steps
/// would leave the rows, and take the mean of two for a measurement.
TEST(Motion, AClockThatBeganIn1970TellsTheSame) {
  const Robot robot = chain(3, Root::fixed);
  const ScratchFolder scratch;
  const auto of = [&](double start, MotionOptions options) {
    const auto path = scratch.path("clock.csv");
    write_log(path, robot, regular_times(start, 500.0, 5000), [&](double t) {
      Sample s = smooth_motion(robot, t - start);
      s.time = t;
      return s;
    });
    return read_motion(path, robot, options);
  };
  for (const Smoothing smoothing : {Smoothing::zero_phase, Smoothing::causal}) {
    MotionOptions options;
    options.smoothing = smoothing;
    const ReadMotion now = of(0.0, options), then = of(1732.0e6, options);
    // Twice what a stamp's 0.24 us are of the half second, or the eight, from which the rate is.
    EXPECT_NEAR(then.report.rate, 500.0, smoothing == Smoothing::causal ? 5e-4 : 3e-5);
    EXPECT_EQ(then.report.gaps, 0U);
    // The last row may be a rounding before or behind the grid's last time.
    const std::size_t common = std::min(then.samples.size(), now.samples.size());
    ASSERT_LE(std::max(then.samples.size(), now.samples.size()), common + 1);
    // 0.6 rad at up to 1.7 Hz, as far as the grid is off in ten seconds: a hundredth of a step.
    constexpr double off = 0.6 * 2.0 * std::numbers::pi * highest * 2e-5;
    EXPECT_LT((then.samples[common - 1].q - now.samples[common - 1].q).cwiseAbs().maxCoeff(), off);
  }
}

// 200 000 rows of 13 columns are 20 MB as doubles, and more as samples.
TEST(Motion, LogsOfAnyLengthTakeFixedMemory) {
#ifdef __SANITIZE_ADDRESS__
  fmt::print("skipped: the address sanitizer keeps freed memory\n");
#else
  const Robot robot = chain(3, Root::fixed);
  const ScratchFolder scratch;
  const auto path = scratch.path("a.csv");
  write_log(path, robot, regular_times(0.0, 1000.0, 200000),
            [&](double t) { return smooth_motion(robot, t); });
  const auto peak_kilobytes = [] {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  const long before = peak_kilobytes();
  MotionReader reader(path, robot, {}, {}, {});
  std::size_t samples = 0;
  while (reader.next()) ++samples;
  const long grown = peak_kilobytes() - before;
  fmt::print("{} samples, peak memory grew by {} kB\n", samples, grown);
  EXPECT_GT(samples, 199800u);
  EXPECT_LT(grown, 10000);
#endif
}

TEST(Motion, SaysWhatItCannotDoWithALog) {
  Robot robot = chain(1, Root::fixed);
  const ScratchFolder scratch;
  const auto good = scratch.path("x.csv");
  write_log(good, robot, regular_times(0.0, 500.0, 1000),
            [&](double t) { return smooth_motion(robot, t); });
  const auto reception = [&](const std::string& path, const MotionOptions& options,
                             const std::optional<Mapping>& mapping = {}) {
    return message_of<InputError>(
        [&] { static_cast<void>(read_motion(path, robot, options, mapping)); }, path);
  };
  MotionOptions options;
  options.rate = 100.0;
  EXPECT_EQ(reception(good, options),
            "rate 100: a grid of 100 Hz for a log of 500 Hz; leave the log's rate: picking rows "
            "would fold "
            "noise into the motion");
  options = {};
  options.cutoff = 300.0;
  EXPECT_EQ(reception(good, options),
            "cutoff 300: a filter of 300 Hz for data at 500 Hz; choose a cutoff between 0 and 250 "
            "Hz, half the rate");
  options = {};
  options.order = 0;
  EXPECT_EQ(reception(good, options), "filter of order 0; choose an order from 1 to 8");

  const auto bare = scratch.write("x.csv", "time,q.j0,tau.j0\n0,1,2\n0.1,1,2\n");
  options = {};
  options.exact_derivatives = true;
  EXPECT_EQ(reception(bare, options),
            "x.csv: lacks derivatives; exact derivatives need dq.* and ddq.*");
  options = {};
  options.use_logged_velocity = true;
  EXPECT_EQ(reception(bare, options),
            "x.csv: has no dq.* columns; log them, or do not ask to use them");
  const auto hole = scratch.write("x.csv", "time,q.j0,dq.j0,ddq.j0,tau.j0\n0,1,1,1,1\n1,1,1,,1\n");
  options = {};
  options.exact_derivatives = true;
  EXPECT_EQ(reception(hole, options),
            "x.csv:3: has an empty field; exact derivatives need every value in every row");
  EXPECT_EQ(reception(scratch.write("x.csv", "time,q.j0,tau.j0\n0,1,2\n"), {}),
            "x.csv: has 1 rows of measurements; a motion takes at least some tenths of a second");
  EXPECT_EQ(reception(scratch.write("x.csv", "time,q.j0,tau.j0\n0,1,\n0.1,2,\n0.2,3,\n"), {}),
            "x.csv, column tau.j0: is empty; tau.j0 needs measurements from the log's beginning");
  Mapping held;
  held.columns["q.j0"] = {.from = "q.j0", .hold = "q"};
  EXPECT_EQ(reception(scratch.write("x.csv", "time,q.j0,tau.j0\n0,1,1\n0.1,1,2\n"), {}, held),
            "x.csv, column q.j0: is held and never changes; q.j0 needs measurements from the log's "
            "beginning");
  robot.contacts.push_back({"l0", 1, ContactKind::point, Eigen::Isometry3d::Identity()});
  EXPECT_EQ(
      reception(bare, {}),
      "x.csv: has no contact.* columns, but the robot has contacts; log a flag for each (0 in "
      "the air), or have them derived");
}

}  // namespace
}  // namespace shapeid
