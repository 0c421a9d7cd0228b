// Which feet touch, for logs that do not say: the vertical force each leg's torques ask for.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::reference {

/// Force along the specific force (up, when the base does not accelerate much) at each contact, N:
/// least squares of the joint rows alone, J_joints^T f = Y Phi - S^T tau, as though all contacts
/// touched; of several at one link, which torques do not tell apart, those of least norm. Depends
/// on the model that is given, so the labels are derived, not measured.
[[nodiscard]] Eigen::VectorXd supporting_forces(const Robot& robot, const Sample& sample,
                                                const Eigen::VectorXd& Phi);

/// Supporting forces as supporting_forces() has them by another torque: column j is what 1 N m (or
/// N) less at joint j adds to each, contacts by joints. A leg that is nearly straight, or that
/// pushes along its joint's axis, has large ones: a little friction there looks like a force.
[[nodiscard]] Eigen::MatrixXd support_per_torque(const Robot& robot, const Sample& sample);

/// Contacts of links on which the supporting forces of all contacts together exceed `share` of the
/// robot's weight.
[[nodiscard]] std::vector<bool> detect_contacts(const Robot& robot, const Sample& sample,
                                                const Eigen::VectorXd& Phi, double share);

}  // namespace shapeid::reference
