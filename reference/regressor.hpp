// Claim C1. Equations (1)-(3): the dynamics of a floating-base tree are linear in the inertial
// parameters.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/reference/kinematics.hpp"

namespace shapeid::reference {

/// Equations (2)-(3): Y with Y Phi = H qddot + C qdot + G, dof x (10 per link). Rows in generalised
/// order: base force (N) and moment about the base origin (N m) in base axes, then joint torques.
/// Columns: ten for each link in the robot's order. A fixed root's columns are zero.
[[nodiscard]] Eigen::MatrixXd regressor(const Robot& robot, const Sample& sample);
/// The same where the links' motions (link_motions()) are there already.
[[nodiscard]] Eigen::MatrixXd regressor(const Robot& robot, const std::vector<LinkMotion>& motions);
/// The ten columns of one link.
[[nodiscard]] Eigen::Matrix<double, Eigen::Dynamic, 10> link_regressor(
    const Robot& robot, const std::vector<LinkMotion>& motions, int link);

/// S^T tau: zeros for the base rows, then the joint torques.
[[nodiscard]] Eigen::VectorXd applied_force(const Robot& robot, const Sample& sample);

}  // namespace shapeid::reference
