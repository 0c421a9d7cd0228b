// How a joint's columns in a log may be meant otherwise than they are read.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::diagnosis {

struct JointReading {
  int joint;
  double position_sign = 1.0, torque_sign = 1.0;
  double further = 0.0;  ///< rad, after the sign

  [[nodiscard]] bool turns_a_sign() const { return position_sign < 0.0 || torque_sign < 0.0; }
  [[nodiscard]] int changes() const {
    return (position_sign < 0.0 ? 1 : 0) + (torque_sign < 0.0 ? 1 : 0) + (further != 0.0 ? 1 : 0);
  }
  void apply(Sample& sample) const;
};

using JointReadings = std::vector<JointReading>;

/// "elbow position of the other sign and +1.5708 rad, wrist torque of the other sign"
[[nodiscard]] std::string words_of(const JointReadings& readings, const Robot& robot);

/// What a model leaves of a log that is read so.
struct ReadingTrial {
  JointReadings readings;
  double left;
};

/// How other readings are tried.
struct ReadingSearch {
  const Robot& robot;
  /// rad by which a joint may be read further, zero among them.
  std::function<std::vector<double>(int joint)> turns;
  /// What a model leaves of the log that is read so, if that is far better than with `before`.
  std::function<std::optional<double>(const JointReadings& readings, const ReadingTrial& before)>
      left_if_far_better;

  /// What the best one leaves is more than this share of what others that are as good leave.
  double as_good;

  /// With `before` and so many further joints the readings with which least is left; of those that
  /// are as good, those that change least: half a turn and a torque of the other sign are
  /// weight as it was.
  [[nodiscard]] std::optional<ReadingTrial> best_beside(const ReadingTrial& before,
                                                        int further_joints = 1) const;
};

}  // namespace shapeid::diagnosis
