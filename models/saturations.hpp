// Readings that stand at the end of what a sensor, or a drive, can say.
#pragma once

#include <cstddef>
#include <vector>

#include "shapeid/models/channels.hpp"

namespace shapeid {

struct Saturation {
  int channel = 0;  ///< of the plan
  double value = 0.0;
  double share = 0.0;  ///< of the rows
};

/// Watches the joints' torques and the axes of the IMU. A channel is saturated where it comes back
/// to the largest of all its readings, or the smallest, and stays there for several rows each time,
/// far more of them than are at the reading next to it: the peaks of what is read in coarse steps
/// are flat as well. (Zero is what an unloaded joint has.)
class Saturations {
 public:
  Saturations(const ChannelPlan& plan, int joints);
  void add(const MeasuredRow& row);
  /// Of what add() has seen.
  [[nodiscard]] std::vector<Saturation> found() const;

 private:
  /// One end of a channel so far, and the reading next to it.
  struct End {
    double sign = 1.0;  ///< of the largest: 1; of the smallest: -1
    double value = 0.0, next = 0.0;
    std::size_t rows = 0, next_rows = 0;  ///< that read these
    std::size_t run = 0, times = 0;       ///< the present run of rows, and runs that were long
    void add(double reading);
    [[nodiscard]] bool is_saturated(std::size_t rows_of_channel) const;
  };
  struct Track {
    int channel = 0;
    std::size_t rows = 0;
    End least{-1.0}, most{1.0};
  };

  std::vector<Track> tracks_;
};

}  // namespace shapeid
