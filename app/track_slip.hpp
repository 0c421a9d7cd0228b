// Feet that slip: contacts that are said to rest on the ground, and do not move together.
#pragma once

#include <cstddef>
#include <vector>

#include "shapeid/fast/contact.hpp"
#include "shapeid/fast/kinematics.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::app {

/// Points at rest on the ground all have the velocity zero, so seen from the base all the same one.
/// A contact slips when it differs from the median of those that touch by more than `fastest` over
/// `shortest`. Of two contacts it cannot be told which one slips: both are named. The equations
/// stay as they are: a slipping foot's force is unknown and projected out like any other.
class SlipWatch {
 public:
  static constexpr double fastest = 0.25;  ///< m/s; a foot that rolls on its rim stays below
  /// s. Longer than the filter and the margin around a lift-off let a leaving foot count as
  /// touching.
  static constexpr double shortest = 0.08;

  SlipWatch(const Robot& robot, double rate);

  /// Number of each contact of the robot that slips now.
  [[nodiscard]] std::vector<int> watch(const Sample& sample);
  void restart() { moving_.assign(moving_.size(), 0); }

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("moving", moving_);
  }

 private:
  const Robot& robot_;
  fast::Kinematics kinematics_;
  fast::ContactJacobian jacobian_;
  std::size_t samples_;              ///< of `shortest`
  std::vector<std::size_t> moving_;  ///< samples in a row, one a contact
};

}  // namespace shapeid::app
