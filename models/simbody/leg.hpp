// One leg for the controller: the chain of joints from the base to a foot. Shares no code with the
// identification.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/models/robot.hpp"

namespace shapeid {

/// The joints between the base and one point contact. The robot must outlive the leg.
class Leg {
 public:
  /// Throws InputError unless exactly three revolute or continuous joints carry the foot.
  Leg(const Robot& robot, const Contact& foot);

  /// Indices of the three joints, from the base to the foot.
  [[nodiscard]] const std::vector<int>& joints() const { return joints_; }
  /// The three entries of the leg's joints out of all.
  [[nodiscard]] Eigen::Vector3d own(const Eigen::VectorXd& all) const;

  /// Foot in base axes for the joints of the leg, m.
  [[nodiscard]] Eigen::Vector3d position(const Eigen::Vector3d& q) const;
  /// d position / d q, m/rad.
  [[nodiscard]] Eigen::Matrix3d jacobian(const Eigen::Vector3d& q) const;
  /// N m at the joints that hold the leg's own weight, for gravity (m/s^2) in base axes.
  [[nodiscard]] Eigen::Vector3d holding_torque(const Eigen::Vector3d& q,
                                               const Eigen::Vector3d& gravity) const;
  /// The joints that put the foot at `target` (base axes, m), by Newton's method from `guess`.
  /// Throws InputError if it is out of reach.
  [[nodiscard]] Eigen::Vector3d reach(const Eigen::Vector3d& target,
                                      const Eigen::Vector3d& guess) const;

 private:
  const Robot* robot_;
  Eigen::Vector3d foot_;     ///< in the frame of the last link
  std::vector<int> joints_;  ///< link of joint j is j + 1
};

}  // namespace shapeid
