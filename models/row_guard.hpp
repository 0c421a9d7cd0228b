// What sensors do wrong while a robot runs: values that jump, values that stand still.
#pragma once

#include <Eigen/Core>

#include <deque>
#include <optional>
#include <vector>

#include "shapeid/models/channels.hpp"

namespace shapeid {

/// What the guard took out of a row. Numbers of channels.
struct RowFaults {
  std::vector<int> outliers;   ///< far from the rows before and after
  std::vector<int> stuck;      ///< repeats one value to the last bit
  std::vector<int> saturated;  ///< the same, at the largest magnitude this channel ever had

  template <class Archive>
  void state(Archive& archive) {
    archive("outliers", outliers);
    archive("stuck", stuck);
    archive("saturated", saturated);
  }
};

struct GuardedRow {
  MeasuredRow row;  ///< with NaN where a value is not to be believed
  RowFaults faults;

  template <class Archive>
  void state(Archive& archive) {
    archive("row", row);
    archive("faults", faults);
  }
};

/// Holds rows back until `reach` newer ones are there, and turns what cannot be a measurement into
/// a missing value, which the resampler interpolates across, or takes as a gap if it lasts.
///
///  * An outlier is further from the median of the `2 half + 1` rows around it than `far` times the
///    furthest of ordinary rows lately, and than 30 percent of the largest magnitude so far.
///  * A channel that repeats its value to the last bit over `reach` rows, and four times as long as
///    it ever did in the first `learning` rows, while most others of its kind (gyro, accelerometer,
///    positions, torques) change: its sensor is stuck, or saturated. All rows of the
///    run that are still held are taken out.
///
/// Logged velocities are not judged: the stream does not use them. Zero is never stuck: it is what
/// a free joint has, and a drive that is off.
class RowGuard {
 public:
  static constexpr std::size_t half = 3;        ///< rows on either side of an outlier
  static constexpr std::size_t reach = 12;      ///< rows held back: 24 ms at 500 Hz
  static constexpr double far = 4.0;            ///< impacts of feet differ less among each other
  static constexpr std::size_t learning = 500;  ///< rows before anything is judged

  /// Of the log of a robot with so many joints.
  RowGuard(const ChannelPlan& plan, std::size_t joints);

  void push(MeasuredRow row);
  /// No row follows the last one directly: hand on what is held.
  void flush();
  [[nodiscard]] std::optional<GuardedRow> next();
  /// s: time of the oldest row that is held back. Only after a push.
  [[nodiscard]] double oldest_held() const { return held_.front().row.time; }

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("held", held_);
    archive("done", done_);
    archive("ordinary", ordinary_);
    archive("largest", largest_);
    archive("last", last_);
    archive("run", run_);
    archive("natural_run", natural_run_);
    archive("judged", judged_);
    archive("seen", seen_);
  }

 private:
  void watch_runs();
  [[nodiscard]] bool others_go_on(std::size_t channel) const;
  void take_out_run(int channel);
  void judge_outliers(std::size_t at);
  void hand_on();

  std::vector<int> kind_;  ///< channels of one kind have one number; -1 is not judged
  std::deque<GuardedRow> held_, done_;
  Eigen::VectorXd ordinary_;      ///< furthest distance from the median of the neighbours, lately
  Eigen::VectorXd largest_;       ///< magnitude so far
  Eigen::VectorXd last_;          ///< value
  std::vector<std::size_t> run_;  ///< how often the last value has been repeated
  std::vector<std::size_t> natural_run_;  ///< the longest while learning
  std::size_t judged_ = 0;                ///< rows of held_ that were looked at for outliers
  std::size_t seen_ = 0;
};

}  // namespace shapeid
