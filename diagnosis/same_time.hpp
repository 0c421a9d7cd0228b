// One log behind several filters: samples of the same instant.
#pragma once

#include <algorithm>

#include "shapeid/diagnosis/recording.hpp"

namespace shapeid::diagnosis {

/// The sample of a recording at a time (s) of another one of the same log and rate, to a quarter of
/// a step; null if it has none there, as where another filter has not settled. It lives as long as
/// the recording.
[[nodiscard]] inline const Sample* sample_at(const Recording& recording, double time) {
  const double near = 0.25 / recording.rate();
  const auto& samples = recording.samples();
  const auto at = std::lower_bound(samples.begin(), samples.end(), time - near,
                                   [](const Sample& s, double t) { return s.time < t; });
  return at != samples.end() && at->time < time + near ? &*at : nullptr;
}

}  // namespace shapeid::diagnosis
