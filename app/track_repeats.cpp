#include "shapeid/app/track_repeats.hpp"

#include <cmath>
#include <limits>

namespace shapeid::app {

RepeatWatch::RepeatWatch(const ChannelPlan& plan, Eigen::Index joints)
    : joints_(joints),
      kinds_{plan.q, plan.tau},
      last_(static_cast<Eigen::Index>(plan.channels.size())) {
  restart();
}

void RepeatWatch::push(const MeasuredRow& row) {
  bool repeats = false;
  for (const Eigen::Index first : kinds_) {
    bool says = false, again = true;
    for (Eigen::Index c = first; c < first + joints_; ++c) {
      const double value = row.values[c];
      if (std::isnan(value)) continue;
      says = true;
      again = again && value == last_[c];
      last_[c] = value;
    }
    repeats = repeats || (says && again);
  }
  // Behind a clock that was set back, nothing is asked of the rows from before.
  if (!rows_.empty() && row.time <= rows_.back().time) rows_.clear();
  rows_.push_back({row.time, repeats});
}

void RepeatWatch::restart() { last_.setConstant(std::numeric_limits<double>::quiet_NaN()); }

bool RepeatWatch::repeats(double time) {
  forget_before(time);
  return !rows_.empty() && rows_[0].repeats && (rows_.size() == 1 || rows_[1].repeats);
}

void RepeatWatch::forget_before(double time) {
  while (rows_.size() > 1 && rows_[1].time <= time) rows_.pop_front();
}

}  // namespace shapeid::app
