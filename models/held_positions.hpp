// Positions that a logger, or an encoder, went on with while the joint moved.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "shapeid/models/channels.hpp"

namespace shapeid {

/// A position that stayed the same to the last bit and then jumped.
struct HeldPosition {
  int joint = 0;
  int line = 0;          ///< of the log, where it begins
  double seconds = 0.0;  ///< that it stayed
  double jump = 0.0;     ///< rad or m, where it ends
};

/// Watches the joints' positions, each by itself. What rests stays the same, too, but goes on as
/// slowly as it came.
class HeldPositions {
 public:
  HeldPositions(const ChannelPlan& plan, int joints);
  void add(const MeasuredRow& row);
  /// The longest, and how many there are: those that ended by a jump larger by far than any step
  /// between readings that follow each other.
  [[nodiscard]] std::optional<HeldPosition> longest(std::size_t& count) const;

 private:
  struct Track {
    bool begun = false;
    double position = 0.0, since = 0.0;  ///< the present one, and when it came, s
    double last = 0.0;                   ///< s, when there was a reading
    int line = 0;
    double largest_step = 0.0;  ///< of readings that were not held
    std::vector<HeldPosition> held;
  };

  const ChannelPlan& plan_;
  std::vector<Track> tracks_;  ///< one a joint
};

}  // namespace shapeid
