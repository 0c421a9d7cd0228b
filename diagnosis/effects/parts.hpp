// Small parts that several effects are made of.
#pragma once

#include <Eigen/Core>

#include <cmath>

#include "shapeid/diagnosis/effect.hpp"

namespace shapeid::diagnosis {

/// One column with `value` in the row of the joint.
inline Eigen::MatrixXd joint_column(const Instant& at, int joint, double value) {
  Eigen::MatrixXd column = Eigen::MatrixXd::Zero(at.robot.dof(), 1);
  column(at.robot.base_dof() + joint, 0) = value;
  return column;
}

/// Direction of motion, smooth through rest: tanh(dq / width).
inline double direction_of(double dq, double width) { return std::tanh(dq / width); }

/// The width of the step of friction through rest. Filters and elastic joints blur it.
inline ShapeNumber step_width() { return {"width", "rad/s", 0.003, 0.3, 0.05}; }

inline bool is_floating(const Robot& robot, int) { return robot.root == Root::floating; }
inline bool is_point_contact(const Robot& robot, int contact) {
  return robot.contacts[static_cast<std::size_t>(contact)].kind == ContactKind::point;
}

}  // namespace shapeid::diagnosis
