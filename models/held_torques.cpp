#include "shapeid/models/held_torques.hpp"

#include <algorithm>
#include <cmath>

#include "shapeid/models/motion_extent.hpp"

namespace shapeid {
namespace {

// s: a drive that reports its torque more seldom is no drive of a log of dynamics.
constexpr double long_held = 0.1;
constexpr std::size_t most_kept = 1000;  // a joint

}  // namespace

HeldTorques::HeldTorques(const ChannelPlan& plan, const Robot& robot)
    : plan_(plan), robot_(robot), tracks_(static_cast<std::size_t>(robot.joint_count())) {}

void HeldTorques::add(const MeasuredRow& row) {
  for (std::size_t j = 0; j < tracks_.size(); ++j) {
    Track& track = tracks_[j];
    const auto joint = static_cast<Eigen::Index>(j);
    const double position = row.values[plan_.q + joint], torque = row.values[plan_.tau + joint];
    if (std::isnan(position) || std::isnan(torque)) continue;
    track.torques.add(torque);
    track.positions.add(position);
    // What went on across a gap is not held.
    const bool goes_on = track.begun && row.time - track.last <= long_held;
    if (!goes_on || torque != track.torque) {
      std::optional<HeldTorque> ended = present(j);
      if (goes_on) {
        const double jump = std::abs(torque - track.torque);
        track.finest = std::min(track.finest, jump);
        if (ended) ended->jump = jump;
      }
      if (ended && track.held.size() < most_kept) track.held.push_back(*ended);
      track.begun = true;
      track.since = row.time;
      track.torque = torque;
      track.line = row.line;
      track.way = {};
    }
    track.last = row.time;
    track.way.add(position);
  }
}

/// What stays at present, if it has stayed long enough.
std::optional<HeldTorque> HeldTorques::present(std::size_t joint) const {
  const Track& track = tracks_[joint];
  const auto j = static_cast<int>(joint);
  const double stayed = track.last - track.since, way = track.way.width();
  if (!(stayed > long_held) || !moved_far(robot_.joint(j), way)) return std::nullopt;
  return HeldTorque{j, track.line, stayed, track.torque, way};
}

std::optional<HeldTorque> HeldTorques::longest(std::size_t& count) const {
  std::optional<HeldTorque> longest;
  count = 0;
  for (std::size_t j = 0; j < tracks_.size(); ++j) {
    const ValueRange& torques = tracks_[j].torques;
    const auto take = [&](const HeldTorque& held) {
      constexpr double steps = 2.5;
      if (held.torque == torques.least || held.torque == torques.most) return;
      if (held.jump < steps * tracks_[j].finest) return;
      ++count;
      if (!longest || held.seconds > longest->seconds) longest = held;
    };
    for (const HeldTorque& held : tracks_[j].held) take(held);
    if (const std::optional<HeldTorque> last = present(j)) take(*last);
  }
  return longest;
}

std::vector<int> HeldTorques::silent() const {
  std::vector<int> silent;
  for (int j = 0; j < robot_.joint_count(); ++j) {
    const Track& track = tracks_[static_cast<std::size_t>(j)];
    const bool zero = track.torques.least == 0.0 && track.torques.most == 0.0;
    if (zero && moved_far(robot_.joint(j), track.positions.width())) silent.push_back(j);
  }
  return silent;
}

}  // namespace shapeid
