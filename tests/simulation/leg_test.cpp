// The controller's kinematics against Simbody, on the bundled robot and on one turned about.
#include "shapeid/models/simbody/leg.hpp"

#include <gtest/gtest.h>

#include "shapeid/models/error.hpp"
#include "shapeid/models/simbody/random.hpp"
#include "shapeid/models/simbody/simbody_robot.hpp"
#include "shapeid/tests/simulation/quadruped.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::scaled_difference;

/// The quadruped with its joints placed and turned oddly.
Robot askew() {
  Robot robot = test::quadruped();
  for (Link& link : robot.links) {
    link.joint.placement.rotate(
        Eigen::AngleAxisd(0.2, Eigen::Vector3d(0.6, 0.0, 0.8)).toRotationMatrix());
  }
  return robot;
}

Eigen::VectorXd random_joints(const Robot& robot, Random& random) {
  Eigen::VectorXd q(robot.joint_count());
  for (double& x : q) x = random.uniform(-1.5, 1.5);
  return q;
}

TEST(Leg, PlacesAndTurnsAsSimbodyDoes) {
  const Robot robot = askew();
  const SimbodyRobot simbody(robot);
  Random random(5);
  for (int round = 0; round < 20; ++round) {
    const Eigen::VectorXd q = random_joints(robot, random);
    const Eigen::Matrix3Xd places = simbody.contact_positions(q);
    const Eigen::MatrixXd J = simbody.contact_point_jacobian(q);
    for (int c = 0; c < 4; ++c) {
      const Leg leg(robot, robot.contacts[static_cast<std::size_t>(c)]);
      EXPECT_LT(scaled_difference(leg.position(leg.own(q)), places.col(c), 10), few_hundred_eps);
      const Eigen::MatrixXd own = J.block<3, 3>(Eigen::Index{3} * c, 6 + leg.joints().front());
      EXPECT_LT(scaled_difference(leg.jacobian(leg.own(q)), own, 10), few_hundred_eps);
    }
  }
}

// At rest inverse dynamics are the torques that hold the links' weight.
TEST(Leg, HoldsItsWeightAsSimbodyDoes) {
  const Robot robot = askew();
  const SimbodyRobot simbody(robot);
  Random random(6);
  Sample rest;
  rest.base_specific_force << 3.0, -5.0, 8.0;
  rest.dq = Eigen::VectorXd::Zero(robot.joint_count());
  rest.ddq = rest.dq;
  rest.q = random_joints(robot, random);
  const Eigen::VectorXd torque = simbody.inverse_dynamics(rest).tail(robot.joint_count());
  for (const Contact& contact : robot.contacts) {
    const Leg leg(robot, contact);
    EXPECT_LT(scaled_difference(leg.holding_torque(leg.own(rest.q), -rest.base_specific_force),
                                leg.own(torque), 10),
              few_hundred_eps);
  }
}

TEST(Leg, ReachesAndSaysWhenItCannot) {
  const Robot robot = test::quadruped();
  const Leg leg(robot, robot.contacts[1]);
  const Eigen::Vector3d target(0.22, 0.15, -0.27);
  const Eigen::Vector3d q = leg.reach(target, {0.0, 0.75, -1.5});
  EXPECT_LT((leg.position(q) - target).norm(), 1e-9);  // stops within 1e-10 m
  EXPECT_THROW(static_cast<void>(leg.reach({0.2, 0.1, -0.5}, q)), InputError);
}

TEST(Leg, NeedsThreeTurningJoints) {
  Robot robot = test::quadruped();
  Contact on_thigh = robot.contacts[0];
  on_thigh.link = robot.find_link("FR_thigh").value();
  EXPECT_THROW(Leg(robot, on_thigh), InputError);
  const auto shank = static_cast<std::size_t>(robot.find_link("FR_shank").value());
  robot.links[shank].joint.kind = JointKind::prismatic;
  EXPECT_THROW(Leg(robot, robot.contacts[0]), InputError);
}

}  // namespace
}  // namespace shapeid
