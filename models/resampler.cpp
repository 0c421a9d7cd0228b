#include "shapeid/models/resampler.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace shapeid {

Resampler::Resampler(double rate, Eigen::VectorXd longest_step)
    : rate_(rate),
      longest_step_(std::move(longest_step)),
      tracks_(static_cast<std::size_t>(longest_step_.size())) {}

void Resampler::push(const MeasuredRow& row) {
  if (!any_) restart(row.time);
  any_ = true;
  newest_ = row.time;
  for (std::size_t c = 0; c < tracks_.size(); ++c) {
    const double value = row.values[static_cast<Eigen::Index>(c)];
    if (!std::isnan(value)) tracks_[c].push_back({row.time, value});
  }
  flags_.push_back({row.time, row.contacts, row.extra});
}

void Resampler::finish() { finished_ = true; }

std::size_t Resampler::held() const {
  std::size_t most = flags_.size();
  for (const Track& track : tracks_) most = std::max(most, track.size());
  return most;
}

void Resampler::restart(double time) {
  anchor_ = time;
  steps_ = 0;
  starts_segment_ = true;
}

/// Drops what lies too far back, so that the point before time() is track[0] or track[1], and says
/// whether the channel can be interpolated there.
Resampler::Look Resampler::look(Track& track, double longest) const {
  const double t = time();
  while (track.size() > 2 && track[2].time <= t) track.pop_front();
  if (track.empty()) return {State::gap, newest_};
  if (track[0].time > t) return {State::gap, track[0].time};
  const std::size_t before = track.size() > 1 && track[1].time <= t ? 1 : 0;
  if (track[before].time == t) return {State::ready};
  const std::size_t after = before + 1;
  // A measurement that is overdue is not waited for: memory stays bounded when a channel dies.
  const auto pending = [&](double last) { return !finished_ && newest_ - last <= longest; };
  if (track.size() == after) {
    return pending(track[before].time) ? Look{State::wait} : Look{State::gap, newest_};
  }
  if (track[after].time - track[before].time > longest) return {State::gap, track[after].time};
  const bool settled = track.size() > after + 1 || !pending(track[after].time);
  return {settled ? State::ready : State::wait};
}

double Resampler::interpolate(const Track& track, double longest) const {
  const double t = time();
  const std::size_t before = track.size() > 1 && track[1].time <= t ? 1 : 0;
  if (track[before].time == t) return track[before].value;
  std::size_t first = before, last = before + 1;
  // Neighbours that are close together (stamps of arrival, in bursts) tell a slope by the noise of
  // both: a cubic through them would amplify it without bound.
  constexpr double close = 0.1;
  const double step = track[last].time - track[before].time;
  const auto helps = [&](double apart) { return apart <= longest && apart >= close * step; };
  if (before > 0 && helps(track[before].time - track[0].time)) first = 0;
  if (track.size() > last + 1 && helps(track[last + 1].time - track[last].time)) ++last;
  double sum = 0.0;  // Lagrange's form
  for (std::size_t i = first; i <= last; ++i) {
    double weight = 1.0;
    for (std::size_t k = first; k <= last; ++k) {
      if (k != i) weight *= (t - track[k].time) / (track[i].time - track[k].time);
    }
    sum += weight * track[i].value;
  }
  return sum;
}

/// Drops the flags of rows that are not the nearest to time() any more.
void Resampler::trim_contacts() {
  const double t = time();
  while (flags_.size() > 1 && std::abs(flags_[1].time - t) <= std::abs(flags_[0].time - t)) {
    flags_.pop_front();
  }
}

std::optional<GridRow> Resampler::next() {
  while (any_ && time() <= newest_) {
    trim_contacts();
    State state = State::ready;
    double until = time();
    for (std::size_t c = 0; c < tracks_.size(); ++c) {
      const Look channel = look(tracks_[c], longest_step_[static_cast<Eigen::Index>(c)]);
      if (channel.state == State::gap) {
        state = State::gap;
        until = std::max(until, channel.until);
      } else if (channel.state == State::wait && state == State::ready) {
        state = State::wait;
      }
    }
    if (state == State::wait) return std::nullopt;
    if (state == State::gap) {
      if (until == time()) return std::nullopt;  // its end is not known yet
      restart(until);
      continue;
    }
    GridRow row{std::exchange(starts_segment_, false), time(),
                Eigen::VectorXd(longest_step_.size()), flags_.front().contacts,
                flags_.front().extra};
    for (std::size_t c = 0; c < tracks_.size(); ++c) {
      const auto i = static_cast<Eigen::Index>(c);
      row.values[i] = interpolate(tracks_[c], longest_step_[i]);
    }
    ++steps_;
    return row;
  }
  return std::nullopt;
}

}  // namespace shapeid
