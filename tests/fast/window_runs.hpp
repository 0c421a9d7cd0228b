// A stream through the fast identifier, each of its windows solved by the reference as well.
#pragma once

#include <string>
#include <vector>

#include "shapeid/fast/identifier.hpp"
#include "shapeid/models/body_model.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::test {

struct WindowRuns {
  int windows = 0;           ///< that were complete
  int declined = 0;          ///< of these, by the fast path
  int divisions = 0;         ///< of the same shapes by both
  int parted = 0;            ///< windows in which another shape was divided next
  double worst_tie = 0.0;    ///< of these: v of the two shapes apart in the reference, over its v
  int stopped = 0;           ///< windows in which fast stops dividing first: its solver declined
  int iterations = 0;        ///< the most in one window
  std::size_t six_rows = 0;  ///< samples by the six-row path
  double worst_objective =
      0.0;                    ///< difference over the problem's terms, before or after a division
  double worst_gap = 0.0;     ///< over the terms of the objective
  double worst_filter = 0.0;  ///< scaled difference of filter (17) by hand
  std::string first_wrong;    ///< what else is wrong, e.g. a window at the wrong sample
};

/// Each window from scratch: reference::Window of its samples, divide_and_solve(), cold.
[[nodiscard]] WindowRuns run_windows(const Robot& robot, const BodyModel& model,
                                     const fast::IdentifierSettings& settings,
                                     const std::vector<Sample>& samples);

/// Steps of the active set that the solves of one window may take: each 100 + 4 (ten a link +
/// shapes), stated in mass_solver.cpp, and one.
[[nodiscard]] int most_iterations(const BodyModel& model, int divisions);

/// In one line.
[[nodiscard]] std::string describe(const WindowRuns& runs);

}  // namespace shapeid::test
