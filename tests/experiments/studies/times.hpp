// How long a window takes, the solve alone and everything.
#pragma once

#include "shapeid/tests/experiments/page/findings.hpp"

namespace shapeid::experiments {

/// Numbers "time.METHOD.solve_us" and "time.METHOD.window_us", medians over the windows of a trot
/// with sensor noise. The window: ten samples to rows without contact forces, compressed, solved.
[[nodiscard]] Findings times(Form form);

}  // namespace shapeid::experiments
