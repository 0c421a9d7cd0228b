#include "shapeid/models/sample_stream.hpp"

#include <algorithm>
#include <utility>

#include "shapeid/models/differences.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/plausibility.hpp"
#include "shapeid/models/row_steps.hpp"

namespace shapeid {

SampleStream::SampleStream(std::string path, const ChannelPlan& plan, const Robot& robot,
                           const Eigen::Isometry3d& imu, StreamOptions options)
    : path_(std::move(path)),
      plan_(plan),
      robot_(robot),
      imu_(imu),
      options_(std::move(options)),
      margin_(ContactChange::widen, margin_of(Smoothing::causal, options_.cutoff)) {
  if (options_.contacts_needed && !robot.contacts.empty() && plan.contacts.empty() &&
      !options_.derive_contacts) {
    throw InputError({path_}, "has no contact.* columns, but the robot has contacts",
                     "log a flag for each (0 in the air), or have them derived");
  }
}

void SampleStream::push(const MeasuredRow& row) {
  if (grid_) return take(row);
  // Rows of two clocks tell no rate; those on either side of a gap do, which the grid will see.
  if (!head_.empty() && !(row.time > head_.back().time)) head_.clear();
  head_.push_back(row);
  if (head_.size() < head_rows) return;
  learn_rate();
  prepare();
  for (const MeasuredRow& early : std::exchange(head_, {})) take(early);
}

void SampleStream::learn_rate() {
  const double step = median_row_step(head_);
  check_clock(path_, plan_.time.from, step);
  row_step_ = step;
  rate_ = options_.rate > 0.0 ? options_.rate : 1.0 / step;
  check_grid(options_.names.rate, rate_, 1.0 / step);
  longest_step_ = gap_steps * median_steps(head_, plan_, path_).cwiseMax(step);
}

void SampleStream::prepare() {
  check_cutoff(options_.names.cutoff, options_.cutoff, rate_);
  grid_.emplace(rate_, longest_step_);
  segments_.emplace(plan_, robot_, imu_, Butterworth(log_filter_order, options_.cutoff, rate_),
                    SegmentSamples::Options{Smoothing::causal, rate_, false});
}

void SampleStream::restart() {
  if (!grid_) return;
  segments_->finish();
  settle();
  margin_.finish();
  grid_.emplace(rate_, longest_step_);
}

void SampleStream::take(const MeasuredRow& row) {
  grid_->push(row);
  while (const std::optional<GridRow> point = grid_->next()) segments_->push(*point);
  settle();
}

void SampleStream::settle() {
  while (std::optional<FlaggedSample> sample = segments_->next()) {
    if (plan_.contacts.empty() && !robot_.contacts.empty() && options_.derive_contacts) {
      const std::optional<std::vector<bool>> derived = options_.derive_contacts(sample->sample);
      sample->contacts.assign(robot_.contacts.size(), -1);
      if (derived) sample->contacts.assign(derived->begin(), derived->end());
    }
    margin_.push(std::move(*sample));
  }
}

std::optional<Sample> SampleStream::next() { return margin_.next(); }

double SampleStream::latency() const {
  // The grid waits for a channel's next value, and for the one behind it, which shapes its curve;
  // the sample is the middle of the rows that are differentiated, and its point of the grid may be
  // a step behind the row.
  const double rows = static_cast<double>(difference_reach) + 1.0;
  return 2.0 * longest_step_.maxCoeff() + rows / rate_ +
         margin_of(Smoothing::causal, options_.cutoff).before;
}

double SampleStream::group_delay() const {
  return Butterworth(log_filter_order, options_.cutoff, rate_).group_delay(0.0);
}

}  // namespace shapeid
