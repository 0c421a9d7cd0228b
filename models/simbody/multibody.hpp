// A Robot as a Simbody system: what SimbodyRobot and the simulation have in common. This header
// includes Simbody (C++17, no NDEBUG) and is for the sources of this folder alone.
#pragma once

#include <Simbody.h>

#include <Eigen/Geometry>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/simbody/robot_state.hpp"

namespace shapeid {

// Between Eigen and Simbody.
[[nodiscard]] SimTK::Vec3 to_vec3(const Eigen::Vector3d& v);
[[nodiscard]] SimTK::Vector to_vector(const Eigen::VectorXd& v);
[[nodiscard]] SimTK::Transform to_transform(const Eigen::Isometry3d& T);
[[nodiscard]] Eigen::Vector3d to_eigen(const SimTK::Vec3& v);
[[nodiscard]] Eigen::VectorXd to_eigen(const SimTK::Vector& v);
[[nodiscard]] Eigen::Matrix3d to_eigen(const SimTK::Rotation& R);
[[nodiscard]] Eigen::MatrixXd to_eigen(const SimTK::Matrix& M);

/// The tree of a Robot in Simbody. Body i is link i; a fixed root is Simbody's ground, a floating
/// root hangs on a Free mobilizer. The first mobilities are those of the base (angular, then
/// linear, both in ground axes), then one for each joint in the robot's order.
class Multibody {
 public:
  /// Throws InputError if a link has a body that cannot exist.
  explicit Multibody(const Robot& robot);
  Multibody(const Multibody&) = delete;
  Multibody& operator=(const Multibody&) = delete;

  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
  SimTK::Force::Gravity gravity{forces, matter, SimTK::Vec3(0, 0, -9.81)};

  [[nodiscard]] const SimTK::MobilizedBody& body(int link) const {
    return bodies_[static_cast<std::size_t>(link)];
  }
  [[nodiscard]] bool floating() const { return floating_; }
  [[nodiscard]] int base_dof() const { return floating_ ? 6 : 0; }
  [[nodiscard]] int joint_count() const { return static_cast<int>(bodies_.size()) - 1; }

  /// Puts a configuration and velocity into a Simbody state.
  void set(SimTK::State& state, const RobotState& robot_state) const;
  [[nodiscard]] RobotState get(const SimTK::State& state) const;

  /// T with u = T nu: Simbody's mobilities from generalised velocities (base linear, base angular,
  /// both in base axes, joints), for a base of attitude R (base to ground). T is orthogonal.
  [[nodiscard]] Eigen::MatrixXd mobilities_from_generalised(const Eigen::Matrix3d& R) const;

 private:
  std::vector<SimTK::MobilizedBody> bodies_;
  bool floating_ = true;
};

}  // namespace shapeid
