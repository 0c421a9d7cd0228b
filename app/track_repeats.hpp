// Rows that say again what the row before said: readings of a robot that rests, behind sensors that
// round.
#pragma once

#include <Eigen/Core>

#include <array>
#include <deque>

#include "shapeid/models/channels.hpp"

namespace shapeid::app {

/// A row repeats the one before when no joint's position differs, or no joint's torque, to the last
/// bit: what is wrong with these is the same again, whatever flickers beside them. A sample repeats
/// when the rows on both sides of it do: one row that is written twice is no rest.
class RepeatWatch {
 public:
  /// Of the log of a robot with so many joints.
  RepeatWatch(const ChannelPlan& plan, Eigen::Index joints);

  /// Rows on their way to the samples, in the order of time.
  void push(const MeasuredRow& row);
  /// The next row does not follow the last one: it repeats nothing.
  void restart();
  /// Whether the sample of this time repeats. To be asked in the order of time, when all rows that
  /// it was made of were pushed.
  [[nodiscard]] bool repeats(double time);
  /// No sample will be asked for from before this time.
  void forget_before(double time);

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("last", last_);
    archive("rows", rows_);
  }

 private:
  struct Row {
    double time = 0.0;  ///< s
    bool repeats = false;
    template <class Archive>
    void state(Archive& archive) {
      archive("time", time);
      archive("repeats", repeats);
    }
  };

  Eigen::Index joints_;
  std::array<Eigen::Index, 2> kinds_;  ///< first channel of positions, of torques
  Eigen::VectorXd last_;               ///< value of each channel; NaN where there is none
  std::deque<Row> rows_;               ///< from the one at or before the last sample on
};

}  // namespace shapeid::app
