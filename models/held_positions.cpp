#include "shapeid/models/held_positions.hpp"

#include <algorithm>
#include <cmath>

namespace shapeid {
namespace {

// s: beyond it a reading is held, where the joint moves; encoders that are read more slowly are no
// encoders of a log of dynamics.
constexpr double long_held = 0.1;
// Larger than any step of the log: a joint that starts is not there before it has been between.
constexpr double by_far = 3.0;
constexpr std::size_t most_kept = 1000;  // a joint

}  // namespace

HeldPositions::HeldPositions(const ChannelPlan& plan, int joints)
    : plan_(plan), tracks_(static_cast<std::size_t>(joints)) {}

void HeldPositions::add(const MeasuredRow& row) {
  for (std::size_t j = 0; j < tracks_.size(); ++j) {
    Track& track = tracks_[j];
    const double position = row.values[plan_.q + static_cast<Eigen::Index>(j)];
    if (std::isnan(position)) continue;
    // What went on across a gap is neither held nor a step.
    const bool follows = track.begun && row.time - track.last <= long_held;
    track.last = row.time;
    if (follows && position == track.position) continue;
    const double step = std::abs(position - track.position), stayed = row.time - track.since;
    if (follows && stayed > long_held) {
      if (track.held.size() < most_kept) {
        track.held.push_back({static_cast<int>(j), track.line, stayed, step});
      }
    } else if (follows) {
      track.largest_step = std::max(track.largest_step, step);
    }
    track.begun = true;
    track.position = position;
    track.since = row.time;
    track.line = row.line;
  }
}

std::optional<HeldPosition> HeldPositions::longest(std::size_t& count) const {
  std::optional<HeldPosition> longest;
  count = 0;
  for (const Track& track : tracks_) {
    for (const HeldPosition& held : track.held) {
      if (!(track.largest_step > 0.0 && held.jump > by_far * track.largest_step)) continue;
      ++count;
      if (!longest || held.seconds > longest->seconds) longest = held;
    }
  }
  return longest;
}

}  // namespace shapeid
