// From measured rows to samples while the robot runs: causal filtering, in fixed memory, with a
// state that can be saved between any two rows.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "shapeid/models/channels.hpp"
#include "shapeid/models/contact_margin.hpp"
#include "shapeid/models/motion.hpp"
#include "shapeid/models/resampler.hpp"
#include "shapeid/models/segment_samples.hpp"

namespace shapeid {

struct StreamOptions {
  MotionOptionNames names;
  double cutoff = 20.0;         ///< Hz, -3 dB; one pass of second order, every channel alike
  double rate = 0.0;            ///< Hz of the grid; 0: the median of the first rows
  ContactRule derive_contacts;  ///< for logs without flags
  bool contacts_needed = true;  ///< as in MotionOptions
};

/// What MotionReader does for a causal stream, with rows pushed in instead of pulled from a file.
/// Every channel has the same group delay; a sample's time is that of the rows it was made from.
class SampleStream {
 public:
  /// Rows from which the rate is taken, if it is not given.
  static constexpr std::size_t head_rows = 256;

  /// `path` names the log in complaints. The plan and the robot must outlive the stream. Throws
  /// InputError if contacts can neither be read nor derived.
  SampleStream(std::string path, const ChannelPlan& plan, const Robot& robot,
               const Eigen::Isometry3d& imu, StreamOptions options);

  /// Rows in the order of time. Throws InputError for a clock or a cutoff that cannot be.
  void push(const MeasuredRow& row);
  /// The next row does not continue the last one: filters start anew, and samples that were held
  /// back for what comes after them are handed out.
  void restart();
  [[nodiscard]] std::optional<Sample> next();
  /// Samples that were left out since the last call, because a contact's flag was not known.
  [[nodiscard]] std::size_t take_unknown_contacts() { return margin_.take_dropped(); }

  /// Hz; 0 as long as it is not known.
  [[nodiscard]] double rate() const { return rate_; }
  /// s, from row to row of the log; 0 before the rate is known.
  [[nodiscard]] double row_step() const { return row_step_; }
  /// s, at low frequency, of every channel; only once the rate is known.
  [[nodiscard]] double group_delay() const;
  /// s: no sample comes that is older than the newest row pushed by more; only once the rate is
  /// known.
  [[nodiscard]] double latency() const;
  /// Stretches of time without gaps, so far.
  [[nodiscard]] std::size_t segments() const { return segments_ ? segments_->segments() : 0; }

  /// All that is remembered, for a checkpoint. When it is read, the same options must have made
  /// this object.
  template <class Archive>
  void state(Archive& archive) {
    archive("rate", rate_);
    archive("row_step", row_step_);
    archive("longest_step", longest_step_);
    if (rate_ > 0.0 && !grid_) prepare();
    archive("head", head_);
    archive("grid", grid_);
    archive("segments", segments_);
    archive("margin", margin_);
  }

 private:
  void learn_rate();
  void prepare();
  void take(const MeasuredRow& row);
  void settle();

  std::string path_;
  const ChannelPlan& plan_;
  const Robot& robot_;
  Eigen::Isometry3d imu_;
  StreamOptions options_;
  double rate_ = 0.0, row_step_ = 0.0;
  Eigen::VectorXd longest_step_;  ///< s, one a channel
  std::deque<MeasuredRow> head_;
  std::optional<Resampler> grid_;
  std::optional<SegmentSamples> segments_;
  ContactMargin margin_;
};

}  // namespace shapeid
