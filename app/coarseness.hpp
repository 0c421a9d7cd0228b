// Notes on an answer whose divisions ended far above their floor, and on one that predicts badly.
#pragma once

#include <optional>

#include "shapeid/app/result.hpp"

namespace shapeid::app {

/// Adds to the result's notes. `floor`: proved; empty: nothing above zero was.
void note_coarse_shapes(Result& result, const Robot& robot, const std::optional<double>& floor);

}  // namespace shapeid::app
