// W of the equations: what robot.yaml says of the noise, at the place of its row.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <string>

#include "shapeid/app/inputs.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/app/command.hpp"

namespace shapeid::test {
namespace {

/// The bundled quadruped with this in place of its robot.yaml.
app::RobotInputs quadruped(Root root, const std::string& yaml) {
  UrdfOptions options;
  options.root = root;
  app::RobotInputs inputs;
  inputs.robot = read_urdf(SHAPEID_SOURCE_DIR "/models/robots/quadruped.urdf", options).robot;
  inputs.notes = read_robot_yaml(scratch_file("weights.robot.yaml", yaml), inputs.robot);
  return inputs;
}

// Powers of two: their inverse squares are exact.
constexpr double tau = 0.5, knee = 0.125, force = 4.0, moment = 0.0625;
const std::string said =
    "noise: {tau: 0.5, tau.FR_knee: 0.125, base.force: 4, base.moment: 0.0625}\n";

double weight_of(double sigma) { return 1.0 / (sigma * sigma); }

/// The joints' part of W, in the robot's order.
void expect_of_joints(const Eigen::VectorXd& W, const Robot& robot) {
  ASSERT_EQ(W.size(), robot.joint_count());
  int knees = 0;
  for (int j = 0; j < robot.joint_count(); ++j) {
    const bool is_it = robot.joint(j).name == "FR_knee";
    EXPECT_EQ(W[j], weight_of(is_it ? knee : tau)) << robot.joint(j).name;
    knees += is_it ? 1 : 0;
  }
  EXPECT_EQ(knees, 1);
}

TEST(Weights, OfForceMomentAndJointsInGeneralisedOrder) {
  const app::RobotInputs inputs = quadruped(Root::floating, said);
  const Eigen::VectorXd W = app::weight(inputs);
  ASSERT_EQ(W.size(), 18);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(W[i], weight_of(force)) << i;
    EXPECT_EQ(W[3 + i], weight_of(moment)) << i;
  }
  expect_of_joints(W.tail(12), inputs.robot);
}

TEST(Weights, OfAFixedBaseAreTheJointsAlone) {
  const app::RobotInputs inputs = quadruped(Root::fixed, said);
  expect_of_joints(app::weight(inputs), inputs.robot);
}

TEST(Weights, AreOneWhereNothingIsSaid) {
  const app::RobotInputs silent = quadruped(Root::floating, "{}\n");
  EXPECT_EQ(app::weight(silent), Eigen::VectorXd::Ones(18));

  // Noise of other channels is none of an equation; a joint that is named speaks for no other.
  const app::RobotInputs others = quadruped(
      Root::floating, "noise: {q: 0.25, dq: 2, base.gyro: 8, base.accel: 16, tau.RL_hip: 0.125}\n");
  Eigen::VectorXd W = Eigen::VectorXd::Ones(18);
  W[6 + others.robot.find_joint("RL_hip").value()] = weight_of(0.125);
  EXPECT_EQ(app::weight(others), W);
}

/// Neither of the two of the base stands for the other.
TEST(Weights, ForceAndMomentOfTheBaseEachForItself) {
  const Eigen::VectorXd of_force = app::weight(quadruped(Root::floating, "noise: {base.force: 4}"));
  EXPECT_EQ(of_force.head<3>(), Eigen::Vector3d::Constant(weight_of(force)));
  EXPECT_EQ(of_force.tail(15), Eigen::VectorXd::Ones(15));
  const Eigen::VectorXd of_moment =
      app::weight(quadruped(Root::floating, "noise: {base.moment: 0.0625}"));
  EXPECT_EQ(of_moment.segment<3>(3), Eigen::Vector3d::Constant(weight_of(moment)));
  EXPECT_EQ(of_moment.head<3>(), Eigen::Vector3d::Ones());
}

}  // namespace
}  // namespace shapeid::test
