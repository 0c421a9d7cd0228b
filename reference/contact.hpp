// The contact Jacobian J of equation (1): where J^T f enters the dynamics.
#pragma once

#include <Eigen/Core>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::reference {

/// Rows of J of every contact that touches in this sample (point 3, line 5, plane 6 rows each),
/// base axes; columns in generalised order. No row if nothing touches.
[[nodiscard]] Eigen::MatrixXd contact_jacobian(const Robot& robot, const Sample& sample);

/// J^T f of equation (4) from the sample's measured forces (point contacts), generalised order.
[[nodiscard]] Eigen::VectorXd measured_contact_force(const Robot& robot, const Sample& sample);

/// Velocity of each contact point in base axes relative to the base origin's velocity, m/s:
/// 3 x contacts. Stance feet should agree on minus the base velocity.
[[nodiscard]] Eigen::Matrix3Xd contact_velocities(const Robot& robot, const Sample& sample);

}  // namespace shapeid::reference
