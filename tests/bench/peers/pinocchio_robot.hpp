// The parts of Pinocchio that compete with ours, for the same robot, built through its model
// interface. Its headers stay in one source file.
#pragma once

#include <Eigen/Core>

#include <memory>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::bench {

/// A sample as Pinocchio takes it: q with the base at rest in the origin, v and a with the base's
/// linear velocity zero and the specific force as its acceleration, in a world without gravity.
struct PinocchioMotion {
  Eigen::VectorXd q, v, a;
};

class PinocchioRobot {
 public:
  /// A floating robot of revolute joints; link inertias from Phi (10 per link, our order).
  PinocchioRobot(const Robot& robot, const Eigen::VectorXd& Phi);
  ~PinocchioRobot();

  [[nodiscard]] static PinocchioMotion motion(const Sample& sample);

  /// computeJointTorqueRegressor: dof x (10 per link). Six inertia entries of each link stand in
  /// Pinocchio's order: Ixx Ixy Iyy Ixz Iyz Izz.
  const Eigen::MatrixXd& regressor(const PinocchioMotion& motion);
  /// bodyRegressor of the base alone: its six rows, without any other link's kinematics.
  [[nodiscard]] static Eigen::Matrix<double, 6, 10> base_regressor(const PinocchioMotion& motion);
  /// rnea: what the links' inertias take, dof.
  const Eigen::VectorXd& inverse_dynamics(const PinocchioMotion& motion);
  /// computeFrameJacobian of one contact's point, local world aligned: J's three linear rows.
  const Eigen::MatrixXd& contact_jacobian(const PinocchioMotion& motion, std::size_t contact);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Our order of a link's ten parameters from Pinocchio's, in place, for each ten columns.
void to_our_order(Eigen::MatrixXd& regressor);

}  // namespace shapeid::bench
