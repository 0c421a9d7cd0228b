// fast::InverseDynamics against reference::regressor times the parameters.
#include "shapeid/fast/inverse_dynamics.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/fast/cases.hpp"
#include "shapeid/tests/fast/first_difference.hpp"
#include "shapeid/tests/support/generators.hpp"

namespace shapeid {
namespace {

using test::no_difference;

std::string difference(fast::InverseDynamics& dynamics, fast::Kinematics& kinematics,
                       const Robot& robot, const Eigen::VectorXd& Phi, const Sample& s) {
  kinematics.start(s);
  const Eigen::MatrixXd Y = reference::regressor(robot, s);
  // Let loose, the root feels all wrenches whole; a joint may feel a small part of a large one.
  Robot loose = robot;
  loose.root = Root::floating;
  const double terms = (reference::regressor(loose, s).cwiseAbs() * Phi.cwiseAbs()).norm();
  return test::first_difference(dynamics(kinematics), Y * Phi, terms, robot.link_count(), robot, s);
}

/// Parameters of some links; those of the others are zero.
Eigen::VectorXd some_parameters(const Robot& robot) {
  Eigen::VectorXd Phi = stacked_parameters(robot);
  for (int i = 0; i < robot.link_count(); ++i) {
    if (*rc::gen::arbitrary<bool>()) Phi.segment<10>(Eigen::Index{10} * i).setZero();
  }
  return Phi;
}

RC_GTEST_PROP(FastInverseDynamics, AsTheRegressorTimesTheParameters, ()) {
  const Robot robot = test::any_robot(1, 20);
  const Eigen::VectorXd Phi = some_parameters(robot);
  fast::Kinematics kinematics(robot);
  fast::InverseDynamics dynamics(robot, Phi);
  for (int k = 0; k < 3; ++k) {  // nothing of an earlier sample stays
    RC_ASSERT(difference(dynamics, kinematics, robot, Phi, *test::sample(robot)) == no_difference);
  }
}

TEST(FastInverseDynamics, CornerCasesAsTheReference) {
  for (const auto& [name, robot] : test::corner_robots()) {
    SCOPED_TRACE(name);
    const Eigen::VectorXd Phi = stacked_parameters(robot);
    fast::Kinematics kinematics(robot);
    fast::InverseDynamics dynamics(robot, Phi);
    for (const Sample& s : test::corner_samples(robot)) {
      EXPECT_EQ(difference(dynamics, kinematics, robot, Phi, s), no_difference);
    }
  }
}

TEST(FastInverseDynamics, OfNothingIsNothing) {
  const Robot robot = test::corner_robots().back().robot;
  fast::Kinematics kinematics(robot);
  fast::InverseDynamics dynamics(robot,
                                 Eigen::VectorXd::Zero(Eigen::Index{10} * robot.link_count()));
  const Sample s = test::corner_samples(robot).back();
  kinematics.start(s);
  EXPECT_TRUE(dynamics(kinematics).isZero(0.0));
}

}  // namespace
}  // namespace shapeid
