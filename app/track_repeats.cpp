#include "shapeid/app/track_repeats.hpp"

#include <cmath>
#include <limits>

namespace shapeid::app {

RepeatWatch::RepeatWatch(const ChannelPlan& plan, Eigen::Index joints)
    : last_(static_cast<Eigen::Index>(plan.channels.size())) {
  restart();
  const auto is_derivative = [](Eigen::Index channel, Eigen::Index first, Eigen::Index size) {
    return first >= 0 && channel >= first && channel < first + size;
  };
  for (Eigen::Index c = 0; c < last_.size(); ++c) {
    // The stream differentiates by itself.
    if (is_derivative(c, plan.dq, joints) || is_derivative(c, plan.ddq, joints) ||
        is_derivative(c, plan.gyrodot, 3)) {
      continue;
    }
    used_.push_back(c);
  }
}

void RepeatWatch::push(const MeasuredRow& row) {
  bool repeats = true;
  for (const Eigen::Index c : used_) {
    const double value = row.values[c];
    if (std::isnan(value)) continue;
    repeats = repeats && value == last_[c];
    last_[c] = value;
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
