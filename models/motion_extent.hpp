// Whether a robot, or a joint, moved at all.
#pragma once

#include <Eigen/Core>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid {

/// Whether `way` (rad or m) is far above encoder noise and elasticity: some degrees, some
/// millimetres.
[[nodiscard]] bool moved_far(const Joint& joint, double way);

/// The least and the most that samples have of positions, of the gyro and of the specific force. A
/// robot that stands still shows a weight in one pose, with an error of next to nothing, and its
/// noise, differentiated, passes for acceleration.
class MotionExtent {
 public:
  void add(const Sample& sample);

  /// A joint turned by more than a degree, or slid by more than a millimetre: encoder noise and
  /// elasticity move as much as that.
  [[nodiscard]] bool some_joint_moved(const Robot& robot) const;
  /// The base turned, at 0.1 rad/s, or was accelerated or tilted, by 1 m/s^2: more than a sensor's
  /// noise behind a filter.
  [[nodiscard]] bool base_moved() const;

 private:
  Eigen::ArrayXd least_, most_;  ///< of gyro, specific force and positions, one after the other
};

}  // namespace shapeid
