// Measured logs: the base, a load on it, a scale of the torques, and a known object.
#pragma once

#include "shapeid/tests/experiments/page/findings.hpp"

namespace shapeid::experiments {

/// Numbers "measured.*"; none if the logs are not there, which it says on standard error.
[[nodiscard]] Findings measured_logs(Form form);

}  // namespace shapeid::experiments
