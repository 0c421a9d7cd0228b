// Signals of one log that are copies of each other: columns that a logger, or who prepared a log,
// wrote twice.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "shapeid/models/channels.hpp"

namespace shapeid {

/// Watches joints' angles, velocities and torques, and the axes of the IMU, each kind by itself.
class EqualSignals {
 public:
  EqualSignals(const ChannelPlan& plan, int joints);
  void add(const MeasuredRow& row);
  /// Columns of the log that said the same in every row that has both, and did not rest. None as
  /// long as there are few rows.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> found() const;

 private:
  void watch_pairs(int first, int count);

  const ChannelPlan& plan_;
  std::vector<std::pair<int, int>> equal_;  ///< channels, so far
  Eigen::VectorXd first_;                   ///< value of every channel, NaN before it has one
  std::vector<bool> changes_;               ///< one a channel
  int rows_ = 0;
};

}  // namespace shapeid
