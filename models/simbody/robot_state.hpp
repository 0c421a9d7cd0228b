// Where a robot is in the world and how it moves: more than a Sample, which needs no world.
#pragma once

#include <Eigen/Geometry>

namespace shapeid {

/// Configuration and velocity in a world whose z axis points up. SI units and radians. For a fixed
/// root the base part is ignored.
struct RobotState {
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity();           ///< base frame in the world
  Eigen::Vector3d base_linear_velocity = Eigen::Vector3d::Zero();   ///< of its origin, base axes
  Eigen::Vector3d base_angular_velocity = Eigen::Vector3d::Zero();  ///< base axes, the gyro
  Eigen::VectorXd q;                                                ///< joint positions, n
  Eigen::VectorXd dq;                                               ///< joint velocities, n
};

}  // namespace shapeid
