// One instant of a robot's motion: all that the dynamics need to know.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/models/robot.hpp"

namespace shapeid {

/// SI units and radians. Base quantities are in base-frame axes at the base link's origin. The
/// dynamics need neither base position, velocity nor attitude: the inertial frame that moves with
/// the base at this instant is as good as any other, and the specific force already contains
/// gravity (docs/derivations/moving-frame.md).
struct Sample {
  double time = 0.0;  ///< s

  Eigen::Vector3d base_angular_velocity = Eigen::Vector3d::Zero();      ///< rad/s, the gyro
  Eigen::Vector3d base_angular_acceleration = Eigen::Vector3d::Zero();  ///< rad/s^2
  /// m/s^2: acceleration of the base origin minus gravity, what an accelerometer there reads.
  /// A fixed upright base reads (0, 0, 9.81).
  Eigen::Vector3d base_specific_force = Eigen::Vector3d(0.0, 0.0, 9.81);

  Eigen::VectorXd q;    ///< joint positions, n; rad or m
  Eigen::VectorXd dq;   ///< joint velocities, n
  Eigen::VectorXd ddq;  ///< joint accelerations, n
  Eigen::VectorXd tau;  ///< joint-side torques or forces on the links, n; N m or N

  /// One entry for each contact of the robot: does it touch? Empty: nothing touches.
  std::vector<bool> in_contact;
  /// Measured contact forces in base axes, N, one for each contact, whatever its flag says; empty
  /// if not measured. Moments that planes and lines transmit are not among them.
  std::vector<Eigen::Vector3d> contact_force;
  /// The log's other columns (MotionReport::extra) in the nearest row, as logged: neither scaled
  /// nor filtered. NaN where the row had none. The dynamics do not use them.
  std::vector<double> extra;

  template <class Archive>
  void state(Archive& archive) {
    archive("time", time);
    archive("base_angular_velocity", base_angular_velocity);
    archive("base_angular_acceleration", base_angular_acceleration);
    archive("base_specific_force", base_specific_force);
    archive("q", q);
    archive("dq", dq);
    archive("ddq", ddq);
    archive("tau", tau);
    archive("in_contact", in_contact);
    archive("contact_force", contact_force);
    archive("extra", extra);
  }
};

/// Empty if the sample has as many numbers as the robot needs, all finite.
[[nodiscard]] Violation why_malformed(const Sample& sample, const Robot& robot);

}  // namespace shapeid
