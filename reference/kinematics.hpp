// Pose, velocity and proper acceleration of every link at one instant, in one place.
//
// Everything is seen from the inertial frame that coincides with the base frame at this instant and
// falls freely with the base origin's present velocity (docs/derivations/moving-frame.md): the base
// origin is at rest in it, and accelerations in it are what accelerometers read.
#pragma once

#include <Eigen/Geometry>

#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::reference {

/// Motion of a link's frame. All vectors in base axes.
struct LinkMotion {
  Eigen::Isometry3d pose;                ///< link coordinates to base coordinates, m
  Eigen::Vector3d angular_velocity;      ///< omega, rad/s
  Eigen::Vector3d velocity;              ///< of the link origin, relative to the base origin's, m/s
  Eigen::Vector3d angular_acceleration;  ///< alpha, rad/s^2
  Eigen::Vector3d proper_acceleration;   ///< of the link origin: acceleration minus gravity, m/s^2
};

/// Motion of every link, in the robot's order.
[[nodiscard]] std::vector<LinkMotion> link_motions(const Robot& robot, const Sample& sample);

/// Empty if there is one for each link.
[[nodiscard]] Violation why_not_motions(const std::vector<LinkMotion>& motions, const Robot& robot);

/// Rows: linear velocity of a point (base axes, m/s), then angular velocity of its link (rad/s).
/// Columns: generalised order.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Jacobian of the point of link number `link` that is now at `point` (base coordinates, m).
[[nodiscard]] Jacobian point_jacobian(const Robot& robot, const std::vector<LinkMotion>& motions,
                                      int link, const Eigen::Vector3d& point);

/// The matrix of the cross product: skew(v) w = v x w.
[[nodiscard]] Eigen::Matrix3d skew(const Eigen::Vector3d& v);

}  // namespace shapeid::reference
