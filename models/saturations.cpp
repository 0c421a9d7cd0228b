#include "shapeid/models/saturations.hpp"

#include <cmath>

namespace shapeid {
namespace {

constexpr std::size_t long_run = 3;  // rows: two may be as large by chance, where steps are coarse
constexpr std::size_t often = 3;     // times: a robot that rests, or a log that is held, comes once
constexpr double much = 0.005;       // of the rows
// The last step below a round peak holds three quarters as many as the peak.
constexpr std::size_t far_more = 4;

}  // namespace

Saturations::Saturations(const ChannelPlan& plan, int joints) {
  const auto watch = [this](int first, int count) {
    for (int k = 0; first >= 0 && k < count; ++k) tracks_.push_back(Track{first + k});
  };
  watch(plan.tau, joints);
  watch(plan.gyro, 3);
  watch(plan.accel, 3);
}

void Saturations::End::add(double reading) {
  const double beyond = rows > 0 ? sign * (reading - value) : 1.0;
  if (beyond > 0.0) {
    *this = {sign, reading, value, 0, rows, 0, 0};
  } else if (beyond < 0.0 && (next_rows == 0 || sign * (reading - next) > 0.0)) {
    next = reading;
    next_rows = 0;
  }
  if (beyond < 0.0 && reading == next) ++next_rows;
  const bool is_there = reading == value;
  if (is_there) ++rows;
  run = is_there ? run + 1 : 0;
  if (run == long_run) ++times;
}

bool Saturations::End::is_saturated(std::size_t rows_of_channel) const {
  const double share = static_cast<double>(rows) / static_cast<double>(rows_of_channel);
  return value != 0.0 && times >= often && share > much && rows > far_more * next_rows;
}

void Saturations::add(const MeasuredRow& row) {
  for (Track& track : tracks_) {
    const double reading = row.values[track.channel];
    if (std::isnan(reading)) continue;
    track.least.add(reading);
    track.most.add(reading);
    ++track.rows;
  }
}

std::vector<Saturation> Saturations::found() const {
  std::vector<Saturation> found;
  for (const Track& track : tracks_) {
    for (const End& end : {track.least, track.most}) {
      if (!end.is_saturated(track.rows)) continue;
      found.push_back({track.channel, end.value,
                       static_cast<double>(end.rows) / static_cast<double>(track.rows)});
    }
  }
  return found;
}

}  // namespace shapeid
