// From the rows of a regular grid to samples: filtered and differentiated within each segment.
#pragma once

#include <Eigen/Geometry>

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "shapeid/models/channels.hpp"
#include "shapeid/models/contact_margin.hpp"
#include "shapeid/models/resampler.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/segment_filter.hpp"

namespace shapeid {

/// Every channel goes through the same filter and the same differences; nothing crosses from one
/// segment into the next, and rows near a segment's ends that the filter has not settled in are
/// left out.
class SegmentSamples {
 public:
  struct Options {
    Smoothing smoothing = Smoothing::zero_phase;
    double rate = 0.0;                 ///< Hz of the grid
    bool use_logged_velocity = false;  ///< see MotionOptions
  };
  /// `plan` and `robot` must outlive this.
  SegmentSamples(const ChannelPlan& plan, const Robot& robot, const Eigen::Isometry3d& imu,
                 const Butterworth& design, const Options& options);

  void push(const GridRow& row);
  /// No more rows will come.
  void finish();
  [[nodiscard]] std::optional<FlaggedSample> next();

  [[nodiscard]] std::size_t segments() const { return segments_; }
  /// Rows that did not become samples, of the segments that have ended.
  [[nodiscard]] std::size_t lost() const { return lost_; }

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("filter", filter_);
    archive("in_filter", in_filter_);
    archive("filtered", filtered_);
    archive("filtered_stamps", filtered_stamps_);
    archive("held", held_);
    archive("ready", ready_);
    archive("since_start", since_start_);
    archive("rows", rows_);
    archive("handed_on", handed_on_);
    archive("segments", segments_);
    archive("lost", lost_);
  }

 private:
  void drain();
  void differentiate();
  void settle(FlaggedSample sample);
  void end_segment();

  const ChannelPlan& plan_;
  const Robot& robot_;
  Eigen::Isometry3d imu_;
  Options options_;
  SegmentFilter filter_;
  std::deque<Stamp> in_filter_;           ///< of rows that have not come out of the filter
  std::deque<Eigen::VectorXd> filtered_;  ///< rows around the one to differentiate
  std::deque<Stamp> filtered_stamps_;     ///< of these
  std::deque<FlaggedSample> held_;        ///< samples that the segment's end may take away
  std::deque<FlaggedSample> ready_;
  Eigen::Index since_start_ = 0;  ///< samples since the segment's beginning
  std::size_t rows_ = 0;          ///< of this segment
  std::size_t handed_on_ = 0;     ///< of this segment
  std::size_t segments_ = 0, lost_ = 0;
};

}  // namespace shapeid
