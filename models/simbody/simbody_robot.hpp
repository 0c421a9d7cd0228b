// The independent physics: a Simbody multibody system made from a Robot. No Simbody header is
// included here, so that the rest of the project can be C++20 and built with NDEBUG.
#pragma once

#include <Eigen/Core>

#include <memory>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid {

/// Inverse dynamics, mass matrix and energies of a Robot, computed by Simbody alone.
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
  /// base gets an arbitrary attitude and linear velocity inside, which must not matter.
  [[nodiscard]] Eigen::VectorXd inverse_dynamics(const Sample& sample) const;

  /// H, dof x dof, generalised order (base velocity in base axes).
  [[nodiscard]] Eigen::MatrixXd mass_matrix(const Eigen::VectorXd& q) const;

  /// Positions, base-frame, of each contact's origin, 3 x contacts, and their Jacobian by Simbody:
  /// 3 rows a contact, whether or not it touches.
  [[nodiscard]] Eigen::Matrix3Xd contact_positions(const Eigen::VectorXd& q) const;
  [[nodiscard]] Eigen::MatrixXd contact_point_jacobian(const Eigen::VectorXd& q) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace shapeid
