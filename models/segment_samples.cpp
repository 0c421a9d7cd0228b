#include "shapeid/models/segment_samples.hpp"

#include <algorithm>
#include <utility>

#include "shapeid/models/differences.hpp"
#include "shapeid/models/sample_builder.hpp"

namespace shapeid {

SegmentSamples::SegmentSamples(const ChannelPlan& plan, const Robot& robot,
                               const Eigen::Isometry3d& imu, const Butterworth& design,
                               const Options& options)
    : plan_(plan),
      robot_(robot),
      imu_(imu),
      options_(options),
      filter_(options.smoothing, design, static_cast<Eigen::Index>(plan.channels.size())) {}

void SegmentSamples::push(const GridRow& row) {
  if (row.starts_segment) {
    end_segment();
    ++segments_;
  }
  ++rows_;
  in_filter_.push_back({row.time, row.contacts, row.extra});
  filter_.push(row.values);
  drain();
}

void SegmentSamples::finish() { end_segment(); }

void SegmentSamples::drain() {
  while (std::optional<Eigen::VectorXd> row = filter_.next()) {
    filtered_.push_back(std::move(*row));
    filtered_stamps_.push_back(std::move(in_filter_.front()));
    in_filter_.pop_front();
    if (filtered_.size() == std::tuple_size_v<Stencil>) differentiate();
  }
}

void SegmentSamples::differentiate() {
  Stencil f;
  std::copy(filtered_.begin(), filtered_.end(), f.begin());
  Stamp& centre = filtered_stamps_[difference_reach];
  Sample sample = make_sample(plan_, robot_, imu_, centre.time, f[difference_reach],
                              first_derivative(f, options_.rate),
                              second_derivative(f, options_.rate), options_.use_logged_velocity);
  sample.extra = std::move(centre.extra);
  settle({std::move(sample), std::move(centre.contacts), false});
  filtered_.pop_front();
  filtered_stamps_.pop_front();
}

/// Hands on what is far enough from both ends of the segment.
void SegmentSamples::settle(FlaggedSample sample) {
  if (since_start_++ < filter_.unsettled()) return;
  held_.push_back(std::move(sample));
  const Eigen::Index behind = options_.smoothing == Smoothing::zero_phase ? filter_.unsettled() : 0;
  if (std::cmp_less_equal(held_.size(), behind)) return;
  ready_.push_back(std::move(held_.front()));
  ready_.back().starts_segment = handed_on_ == 0;
  held_.pop_front();
  ++handed_on_;
}

void SegmentSamples::end_segment() {
  filter_.finish();
  drain();
  lost_ += rows_ - handed_on_;
  filter_.reset();
  in_filter_.clear();
  filtered_.clear();
  filtered_stamps_.clear();
  held_.clear();
  since_start_ = 0;
  rows_ = handed_on_ = 0;
}

std::optional<FlaggedSample> SegmentSamples::next() {
  if (ready_.empty()) return std::nullopt;
  FlaggedSample sample = std::move(ready_.front());
  ready_.pop_front();
  return sample;
}

}  // namespace shapeid
