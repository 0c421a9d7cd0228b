// What the tests of the physics share: velocities in generalised order, and what an error in
// generalised forces is measured against (the terms that were added up, not their sum, which may be
// far smaller).
#pragma once

#include <Eigen/Core>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/reference/regressor.hpp"

namespace shapeid::test {

/// || |Y| |Phi| ||: a backward stable way to Y Phi errs by a few eps of this for each operation on
/// the longest way through the tree.
[[nodiscard]] inline double size_of_terms(const Eigen::MatrixXd& Y, const Eigen::VectorXd& Phi) {
  return (Y.cwiseAbs() * Phi.cwiseAbs()).norm();
}

/// The same for inverse dynamics in which gravity acts as a force: acceleration and weight then
/// cancel (entirely in free fall), so the terms of a robot at rest in gravity are added.
[[nodiscard]] inline double size_of_terms_with_weight(const Robot& robot, const Sample& sample) {
  Sample at_rest = sample;
  at_rest.base_angular_velocity.setZero();
  at_rest.base_angular_acceleration.setZero();
  at_rest.base_specific_force = Eigen::Vector3d::Constant(9.81);
  at_rest.dq.setZero();
  at_rest.ddq.setZero();
  const Eigen::VectorXd Phi = stacked_parameters(robot);
  return size_of_terms(reference::regressor(robot, sample), Phi) +
         size_of_terms(reference::regressor(robot, at_rest), Phi);
}

/// In generalised order, for a base whose origin moves with `linear` (base axes, m/s).
[[nodiscard]] inline Eigen::VectorXd generalised_velocity(const Robot& robot,
                                                          const Eigen::Vector3d& linear,
                                                          const Sample& sample) {
  Eigen::VectorXd velocity = Eigen::VectorXd::Zero(robot.dof());
  velocity.tail(robot.joint_count()) = sample.dq;
  if (robot.root == Root::floating) {
    velocity.head<3>() = linear;
    velocity.segment<3>(3) = sample.base_angular_velocity;
  }
  return velocity;
}

}  // namespace shapeid::test
