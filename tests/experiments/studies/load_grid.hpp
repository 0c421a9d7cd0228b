// Figures 6, 7, 10 and 11: an unknown load over places, masses, sizes and heights, with the true
// robot model and with one that was identified.
#pragma once

#include "shapeid/tests/experiments/page/findings.hpp"

namespace shapeid::experiments {

/// Numbers "load.grid.MODEL.MASSkg.{d0,d5,d10,d20,d40,stop}.{mass,place_mm,tensor}.*" over nine
/// places; MODEL is true or identified. "load.grid.MODEL.MASSkg.divisions.*": where the step rule
/// stops. "load.grid.fell": cases in which the robot fell under its load, which are left out.
[[nodiscard]] Findings load_grid(Form form);

/// "load.shape.*": one place, several sizes and heights of the block.
[[nodiscard]] Findings load_shapes(Form form);

}  // namespace shapeid::experiments
