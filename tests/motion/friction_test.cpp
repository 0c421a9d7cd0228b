// The trap that the same filter over every channel avoids: a pendulum without friction, logged with
// noise, must be identified without friction.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <cmath>
#include <numbers>
#include <random>

#include "shapeid/models/log_writer.hpp"
#include "shapeid/models/motion.hpp"
#include "shapeid/tests/motion/example.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::chain;
using test::read_motion;
using test::regular_times;
using test::ScratchFolder;

constexpr double inertia = 0.07, weight = 2.3;  // kg m^2, N m
constexpr double log_rate = 500.0;

/// tau = inertia ddq + weight sin q, exactly; no friction.
Sample pendulum(double t) {
  Sample s;
  s.time = t;
  s.q = s.dq = s.ddq = s.tau = Eigen::VectorXd::Zero(1);
  for (const double f : {0.7, 1.9, 3.3}) {
    const double w = 2.0 * std::numbers::pi * f, a = w * t + f;
    s.q[0] += 0.4 * std::sin(a);
    s.dq[0] += 0.4 * w * std::cos(a);
    s.ddq[0] -= 0.4 * w * w * std::sin(a);
  }
  s.tau[0] = inertia * s.ddq[0] + weight * std::sin(s.q[0]);
  return s;
}

struct Noise {
  double q = 0.0, tau = 0.0;  ///< standard deviations, rad and N m
};

std::string write_pendulum(const ScratchFolder& scratch, const Noise& noise, std::uint32_t seed) {
  auto path = scratch.path("a.csv");
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  LogWriter writer(path, {"time", "q.j0", "tau.j0"});
  for (const double t : regular_times(0.0, log_rate, 10000)) {
    const Sample s = pendulum(t);
    writer.write({t, s.q[0] + noise.q * normal(random), s.tau[0] + noise.tau * normal(random)});
  }
  writer.close();
  return path;
}

/// Least squares of tau on ddq, sin q and dq: the last coefficient is viscous friction.
Eigen::Vector3d fit(const std::vector<Sample>& motion, const std::vector<Sample>& torque) {
  const auto rows = static_cast<Eigen::Index>(std::min(motion.size(), torque.size()));
  Eigen::MatrixXd Y(rows, 3);
  Eigen::VectorXd tau(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const Sample& s = motion[static_cast<std::size_t>(k)];
    Y.row(k) << s.ddq[0], std::sin(s.q[0]), s.dq[0];
    tau[k] = torque[static_cast<std::size_t>(k)].tau[0];
  }
  return Y.householderQr().solve(tau);
}

MotionOptions with(Smoothing smoothing, double cutoff) {
  MotionOptions options;
  options.smoothing = smoothing;
  options.cutoff = cutoff;
  return options;
}

/// Joins samples at equal times: two readers lose different ends.
void align(std::vector<Sample>& a, std::vector<Sample>& b) {
  const auto drop_before = [](std::vector<Sample>& x, double time) {
    std::erase_if(x, [&](const Sample& s) { return s.time < time - 0.5 / log_rate; });
  };
  drop_before(a, b.front().time);
  drop_before(b, a.front().time);
}

// Without noise what remains is the filter's distortion of sin q, which is not linear: of second
// order in the motion's frequency over the cutoff, and free of phase.
TEST(Friction, OneFilterOverAllChannelsInventsNone) {
  const Robot robot = chain(1, Root::fixed);
  const ScratchFolder scratch;
  for (const Smoothing smoothing : {Smoothing::zero_phase, Smoothing::causal}) {
    std::vector<double> viscous;
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
      const auto path = write_pendulum(scratch, {1e-5, 0.02}, seed);
      const auto samples = read_motion(path, robot, with(smoothing, 20.0)).samples;
      const Eigen::Vector3d found = fit(samples, samples);
      EXPECT_NEAR(found[0], inertia, 0.02 * inertia);
      EXPECT_NEAR(found[1], weight, 0.02 * weight);
      viscous.push_back(found[2]);
    }
    const auto sample = Eigen::Map<const Eigen::VectorXd>(viscous.data(), 8);
    const double mean = sample.mean();
    const double error = std::sqrt((sample.array() - mean).square().sum() / (7.0 * 8.0));
    fmt::print("{}: viscous friction {:.2e} +- {:.2e} N m s\n",
               smoothing == Smoothing::causal ? "causal" : "zero phase", mean, error);
    // Student's t with 7 degrees of freedom: beyond 5.4 by chance once in a thousand.
    EXPECT_LT(std::abs(mean), 5.4 * error);
  }
}

// As often published: q is filtered, the torque is not. The delay turns inertia into friction:
// tau(t) = I ddq(t), seen through q late by d, is I ddq_late(t + d) = I ddq_late + I d dddq_late,
// and on a sine dddq = -w^2 dq: a viscous coefficient of about -I d w^2 plus what gravity adds.
TEST(Friction, FilteringTheJointsAloneInventsIt) {
  const Robot robot = chain(1, Root::fixed);
  const ScratchFolder scratch;
  const auto path = write_pendulum(scratch, {1e-5, 0.02}, 1);
  std::vector<Sample> raw = read_motion(path, robot, with(Smoothing::none, 20.0)).samples;
  auto [late, report] = read_motion(path, robot, with(Smoothing::causal, 20.0));
  std::vector<Sample> late_with_own = late;
  align(raw, late);
  const double trap = fit(late, raw)[2], honest = fit(late_with_own, late_with_own)[2];
  fmt::print("viscous friction: {:.4f} N m s with q alone filtered, {:.5f} with all\n", trap,
             honest);
  // The power balance of the highest and strongest component alone: I d w^2.
  const double w = 2.0 * std::numbers::pi * 3.3;
  EXPECT_LT(trap, -0.3 * inertia * report.group_delay * w * w);
  EXPECT_GT(trap, -1.5 * inertia * report.group_delay * w * w);
  EXPECT_LT(std::abs(honest), 0.03 * std::abs(trap));
}

}  // namespace
}  // namespace shapeid
