// The independent physics: a Simbody multibody system made from a Robot. No Simbody header is
// included here, so that the rest of the project can be C++20 and built with NDEBUG.
#pragma once

#include <Eigen/Core>

#include <memory>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/models/simbody/robot_state.hpp"

namespace shapeid {

/// Inverse dynamics, mass matrix and energies of a Robot, computed by Simbody alone. Not for use by
/// two threads at once: each call works in one Simbody state.
class SimbodyRobot {
 public:
  /// Every link must have a body that can exist (Simbody refuses others): throws InputError.
  explicit SimbodyRobot(const Robot& robot);
  ~SimbodyRobot();
  SimbodyRobot(SimbodyRobot&&) noexcept;
  SimbodyRobot& operator=(SimbodyRobot&&) noexcept;
  SimbodyRobot(const SimbodyRobot&) = delete;
  SimbodyRobot& operator=(const SimbodyRobot&) = delete;

  /// H qddot + C qdot + G in generalised order (base rows in base axes at the base origin). The
  /// base gets an arbitrary attitude, place and linear velocity inside, which must not matter. A
  /// fixed root does not turn: of its base quantities only the specific force is used. Gravity acts
  /// as a force here, so the result carries rounding of the size of the robot's weight even where a
  /// sample is weightless.
  [[nodiscard]] Eigen::VectorXd inverse_dynamics(const Sample& sample) const;

  /// H, dof x dof, generalised order (base velocity in base axes).
  [[nodiscard]] Eigen::MatrixXd mass_matrix(const Eigen::VectorXd& q) const;

  /// Positions, base-frame, of each contact's origin, 3 x contacts, and their Jacobian by Simbody:
  /// 3 rows a contact, whether or not it touches.
  [[nodiscard]] Eigen::Matrix3Xd contact_positions(const Eigen::VectorXd& q) const;
  [[nodiscard]] Eigen::MatrixXd contact_point_jacobian(const Eigen::VectorXd& q) const;

  /// J, of all links (a fixed root has none) at this configuration and velocity.
  [[nodiscard]] double kinetic_energy(const RobotState& state) const;
  /// J, in the gravity of `gravity()`, zero for bodies at the height of the world's origin.
  [[nodiscard]] double potential_energy(const RobotState& state) const;
  /// m/s^2, world axes: (0, 0, -9.81).
  [[nodiscard]] static Eigen::Vector3d gravity();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace shapeid
