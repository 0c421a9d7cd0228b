#include "shapeid/diagnosis/joint_reading.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace shapeid::diagnosis {
namespace {

/// All but that of the log.
JointReadings other_readings(int joint, const std::vector<double>& turns) {
  JointReadings others;
  for (const double position_sign : {1.0, -1.0}) {
    for (const double torque_sign : {1.0, -1.0}) {
      for (const double further : turns) {
        const JointReading reading{joint, position_sign, torque_sign, further};
        if (reading.changes() > 0) others.push_back(reading);
      }
    }
  }
  return others;
}

int changes(const JointReadings& readings) {
  int sum = 0;
  for (const JointReading& r : readings) sum += r.changes();
  return sum;
}

ReadingTrial simplest_of_best(std::vector<ReadingTrial> trials, double as_good) {
  const double least = std::ranges::min(trials, {}, &ReadingTrial::left).left;
  std::erase_if(trials, [&](const ReadingTrial& t) { return as_good * t.left > least; });
  return std::ranges::min(
      trials, {}, [](const ReadingTrial& t) { return std::pair(changes(t.readings), t.left); });
}

/// Calls `use` with `readings` and each reading of so many further joints from number `from` on.
void for_each_further(const ReadingSearch& search, const JointReadings& readings, int from,
                      int further, const std::function<void(const JointReadings&)>& use) {
  if (further == 0) return use(readings);
  for (int j = from; j < search.robot.joint_count(); ++j) {
    const bool is_read = std::ranges::any_of(readings, [j](auto& r) { return r.joint == j; });
    if (is_read) continue;
    for (const JointReading& other : other_readings(j, search.turns(j))) {
      JointReadings with = readings;
      with.push_back(other);
      for_each_further(search, with, j + 1, further - 1, use);
    }
  }
}

}  // namespace

void JointReading::apply(Sample& sample) const {
  sample.q[joint] = position_sign * sample.q[joint] + further;
  sample.dq[joint] *= position_sign;
  sample.ddq[joint] *= position_sign;
  sample.tau[joint] *= torque_sign;
}

std::string words_of(const JointReadings& readings, const Robot& robot) {
  std::vector<std::string> each;
  each.reserve(readings.size());
  for (const JointReading& r : readings) {
    std::vector<std::string> parts;
    if (r.position_sign < 0.0) parts.emplace_back("position of the other sign");
    if (r.further != 0.0) parts.push_back(fmt::format("{:+.4f} rad", r.further));
    if (r.torque_sign < 0.0) parts.emplace_back("torque of the other sign");
    each.push_back(fmt::format("{} {}", robot.joint(r.joint).name, fmt::join(parts, " and ")));
  }
  return fmt::format("{}", fmt::join(each, ", "));
}

std::optional<ReadingTrial> ReadingSearch::best_beside(const ReadingTrial& before,
                                                       int further_joints) const {
  std::vector<ReadingTrial> trials;
  for_each_further(*this, before.readings, 0, further_joints, [&](const JointReadings& with) {
    if (const std::optional<double> left = left_if_far_better(with, before)) {
      trials.push_back({with, *left});
    }
  });
  if (trials.empty()) return std::nullopt;
  return simplest_of_best(std::move(trials), as_good);
}

}  // namespace shapeid::diagnosis
