// The arm's forward simulation and what disturbs simulated robots.
#include "shapeid/models/simbody/tracking.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "shapeid/models/simbody/simbody_robot.hpp"
#include "shapeid/models/simbody/simulation.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/simulation/quadruped.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

Robot arm() {
  UrdfOptions fixed;
  fixed.root = Root::fixed;
  return read_urdf(SHAPEID_SOURCE_DIR "/tests/blind/arm.urdf", fixed).robot;
}

TrackingOptions short_motion() {
  TrackingOptions options;
  options.wanted.duration = 1.0;
  options.wanted.frequency = 0.5;
  return options;
}

std::vector<Sample> track(const TrackingOptions& options) {
  std::vector<Sample> samples;
  simulate_tracking(arm(), options, [&](const Sample& s) { samples.push_back(s); });
  return samples;
}

double viscous_error(const Sample& s, const SimbodyRobot& robot, double b) {
  const Eigen::VectorXd rigid = robot.inverse_dynamics(s);
  return test::scaled_difference(rigid + b * s.dq, s.tau, 10);
}

TEST(Tracking, EquationOfMotionHoldsInEverySample) {
  const SimbodyRobot robot(arm());
  for (const Sample& s : track(short_motion())) {
    ASSERT_LT(viscous_error(s, robot, 0.0), test::few_hundred_eps) << s.time;
  }
}

TEST(Tracking, FrictionIsWhatTheDrivesGiveMore) {
  constexpr double b = 0.8;
  TrackingOptions options = short_motion();
  options.disturbance = [b](const DisturbedState& s, DisturbingForces& f) { f.joint -= b * s.dq; };
  const SimbodyRobot robot(arm());
  const std::vector<Sample> samples = track(options);
  for (const Sample& s : samples) {
    ASSERT_LT(viscous_error(s, robot, b), test::few_hundred_eps) << s.time;
  }
  // The controller does not know of it: the motion differs.
  EXPECT_GT((samples.back().q - track(short_motion()).back().q).norm(), 1e-3);
}

TEST(Tracking, LoadIsThereFromItsMomentOn) {
  TrackingOptions options = short_motion();
  options.load = Load{4, 0.7, Eigen::Vector3d::Constant(0.05), {0.01, 0.0, 0.06}};
  options.load_from = 0.5;
  const SimbodyRobot bare(arm()), loaded(with_load(arm(), *options.load));
  for (const Sample& s : track(options)) {
    const SimbodyRobot& robot = s.time < options.load_from - 1e-9 ? bare : loaded;
    ASSERT_LT(viscous_error(s, robot, 0.0), test::few_hundred_eps) << s.time;
  }
}

TEST(Disturbance, ForceOnALinkOfTheTrotterEntersItsBalance) {
  SimulationOptions options;
  options.duration = 0.2;
  const Eigen::Vector3d pull(3.0, -2.0, 4.0);  // N, base axes, at the base's origin
  options.disturbance = [&](const DisturbedState& s, DisturbingForces& f) {
    f.link[0] += s.attitude[0] * pull;
  };
  const Robot robot = test::quadruped();
  const SimbodyRobot simbody(robot);
  simulate(robot, options, [&](const SimulatedSample& s) {
    const Eigen::VectorXd asked = simbody.inverse_dynamics(s.sample);
    Eigen::Vector3d given = pull;
    for (const Eigen::Vector3d& force : s.sample.contact_force) given += force;
    ASSERT_LT(test::scaled_difference(Eigen::VectorXd(asked.head<3>()), Eigen::VectorXd(given), 20),
              test::few_hundred_eps)
        << s.sample.time;
  });
}

}  // namespace
}  // namespace shapeid
