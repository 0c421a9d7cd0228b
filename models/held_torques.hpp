// Torques that a logger, or a drive, went on with while the joint moved, and such that never were.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "shapeid/models/channels.hpp"
#include "shapeid/models/value_range.hpp"

namespace shapeid {

/// A torque that stayed the same to the last bit.
struct HeldTorque {
  int joint = 0;
  int line = 0;          ///< of the log, where it begins
  double seconds = 0.0;  ///< that it stayed
  double torque = 0.0;   ///< N m or N
  double way = 0.0;      ///< that the joint moved meanwhile, rad or m
  /// N m or N, by which the torque changed then; infinity if the log ends, or has a gap.
  double jump = std::numeric_limits<double>::infinity();
};

/// Watches the joints' torques, each by itself. A drive at its limit stays there, too: what is the
/// largest or the smallest of all of a joint's torques is not held. Nor is what goes on by a step
/// of the reading: at constant speed a coarse one stays.
class HeldTorques {
 public:
  HeldTorques(const ChannelPlan& plan, const Robot& robot);
  void add(const MeasuredRow& row);
  /// Of what add() has seen: the longest, and how many there are.
  [[nodiscard]] std::optional<HeldTorque> longest(std::size_t& count) const;
  /// Joints that moved, and whose torque was zero in every row.
  [[nodiscard]] std::vector<int> silent() const;

 private:
  struct Track {
    bool begun = false;
    double since = 0.0, last = 0.0;  ///< s: of the present torque, and of the last reading
    double torque = 0.0;             ///< the present one
    int line = 0;                    ///< likewise
    ValueRange way;                  ///< of the position while it stays
    ValueRange torques, positions;   ///< of the whole log
    double finest = std::numeric_limits<double>::infinity();  ///< change from row to row
    std::vector<HeldTorque> held;
  };
  [[nodiscard]] std::optional<HeldTorque> present(std::size_t joint) const;

  const ChannelPlan& plan_;
  const Robot& robot_;
  std::vector<Track> tracks_;  ///< one a joint
};

}  // namespace shapeid
