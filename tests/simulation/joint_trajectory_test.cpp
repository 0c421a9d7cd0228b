#include "shapeid/models/simbody/joint_trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/simbody/simbody_robot.hpp"
#include "shapeid/tests/simulation/quadruped.hpp"

namespace shapeid {
namespace {

Robot mounted_quadruped() {
  Robot robot = test::quadruped();
  robot.root = Root::fixed;
  robot.contacts.clear();
  return robot;
}

std::vector<Sample> run(const Robot& robot, const JointTrajectoryOptions& options) {
  std::vector<Sample> samples;
  simulate_joint_trajectory(robot, options, [&](const Sample& s) { samples.push_back(s); });
  return samples;
}

TEST(JointTrajectory, StaysWithinLimitsAndMovesEveryJoint) {
  const Robot robot = mounted_quadruped();
  const auto samples = run(robot, {});
  ASSERT_EQ(samples.size(), 5001u);
  for (int j = 0; j < robot.joint_count(); ++j) {
    const Joint& joint = robot.joint(j);
    double lowest = samples[0].q[j];
    double highest = lowest;
    for (const Sample& s : samples) {
      lowest = std::min(lowest, s.q[j]);
      highest = std::max(highest, s.q[j]);
      ASSERT_LE(std::abs(s.dq[j]), joint.velocity);
    }
    EXPECT_GE(lowest, joint.lower);
    EXPECT_LE(highest, joint.upper);
    EXPECT_GT(highest - lowest, 0.2 * (joint.upper - joint.lower));
  }
}

TEST(JointTrajectory, VelocitiesAndAccelerationsAreTheDerivatives) {
  JointTrajectoryOptions options;
  options.duration = 0.5;
  options.rate = 10000.0;
  const auto s = run(mounted_quadruped(), options);
  const double h = 1.0 / options.rate;
  // Truncation of a central difference is h^2 / 6 of the third derivative, here at most about
  // 1 rad x (5 x 0.94 / s)^3; ten times that, plus rounding of 1 rad by eps / h.
  const double slack = 10.0 * h * h / 6.0 * 104.0 + 1e-11;
  for (std::size_t i = 1; i + 1 < s.size(); i += 97) {
    EXPECT_LT(((s[i + 1].q - s[i - 1].q) / (2.0 * h) - s[i].dq).cwiseAbs().maxCoeff(), slack);
    EXPECT_LT(((s[i + 1].dq - s[i - 1].dq) / (2.0 * h) - s[i].ddq).cwiseAbs().maxCoeff(),
              5.0 * slack);
  }
}

// Work of the torques = change of energy, by integrating with Simpson's rule: a check of the
// torques that does not pass through inverse dynamics again.
TEST(JointTrajectory, TorquesDoTheWorkThatTheEnergyNeeds) {
  const Robot robot = mounted_quadruped();
  JointTrajectoryOptions options;
  options.duration = 2.0;
  const auto s = run(robot, options);
  const SimbodyRobot simbody(robot);
  const auto energy = [&](const Sample& sample) {
    RobotState state;
    state.q = sample.q;
    state.dq = sample.dq;
    return simbody.kinetic_energy(state) + simbody.potential_energy(state);
  };
  double work = 0.0;
  double scale = 0.0;
  for (std::size_t i = 0; i + 2 < s.size(); i += 2) {
    const double simpson =
        s[i].tau.dot(s[i].dq) + 4.0 * s[i + 1].tau.dot(s[i + 1].dq) + s[i + 2].tau.dot(s[i + 2].dq);
    work += simpson / (3.0 * options.rate);
    scale += std::abs(simpson) / (3.0 * options.rate);
  }
  // Simpson's error at 500 Hz for motion of a few hertz: (5 x 0.15 x 2 pi x 2 / 500)^4 / 180.
  constexpr double simpson_error = 1e-9;
  EXPECT_GT(scale, 1.0);
  EXPECT_LT(std::abs(energy(s.back()) - energy(s.front()) - work), simpson_error * scale);
}

TEST(JointTrajectory, TheSeedDecides) {
  JointTrajectoryOptions options;
  options.duration = 0.1;
  const Robot robot = mounted_quadruped();
  EXPECT_EQ(run(robot, options).back().tau, run(robot, options).back().tau);
  const Eigen::VectorXd before = run(robot, options).back().tau;
  options.seed = 2;
  EXPECT_NE(run(robot, options).back().tau, before);
}

TEST(JointTrajectory, RefusesOptionsThatMakeNoSense) {
  const auto ignore = [](const Sample&) {};
  EXPECT_THROW(simulate_joint_trajectory(test::quadruped(), {}, ignore), InputError);
  JointTrajectoryOptions options;
  options.reach = 1.5;
  EXPECT_THROW(simulate_joint_trajectory(mounted_quadruped(), options, ignore), InputError);
  options = {};
  options.harmonics = 0;
  EXPECT_THROW(simulate_joint_trajectory(mounted_quadruped(), options, ignore), InputError);
}

}  // namespace
}  // namespace shapeid
