// Windows of samples: the same rows for every method.
#pragma once

#include <vector>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/tests/experiments/methods/data_term.hpp"

namespace shapeid::experiments {

struct TimedWindow {
  double time;  ///< s, of its last sample
  DataTerm f;
};

/// The paper's: 10 samples at 500 Hz, one window behind the other every 20 ms.
inline constexpr std::size_t published_window = 10;

/// Consecutive windows of `length` samples, contact forces projected out, W = 1. `model` has one
/// free link. A last window that is not full is left out.
[[nodiscard]] std::vector<TimedWindow> windows(const Robot& robot, const BodyModel& model,
                                               const std::vector<Sample>& samples,
                                               std::size_t length);

/// All samples as one window.
[[nodiscard]] DataTerm whole(const Robot& robot, const BodyModel& model,
                             const std::vector<Sample>& samples);

}  // namespace shapeid::experiments
