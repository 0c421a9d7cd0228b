// Whether what is left of a joint is noise: a residual that no curve describes may still remember
// itself.
#pragma once

#include <vector>

#include "shapeid/diagnosis/unexplained.hpp"

namespace shapeid::diagnosis {

/// Structure::variable of what is slow.
inline constexpr const char* slow = "frequency";

/// Joints whose residual is slow: its power below a fifth of the filter's `cutoff` (Hz) is larger
/// than between a quarter and a half of it, or than that of the torque's noise (`noise` of each
/// joint: torque_noise(), or not a number), by more than chance. Noise of torque is as strong at
/// all frequencies that the filter leaves, noise of motion grows with frequency, and what masses
/// take away is slow; so what is slow and no noise has a cause. The curve is the residual's
/// amplitude (N m) over frequency (Hz), `t` the logarithm of the ratio of powers over its standard
/// error.
[[nodiscard]] std::vector<Structure> slow_remains(const Robot& robot, const Recording& recording,
                                                  const Series& series, double cutoff,
                                                  const std::vector<double>& noise);

}  // namespace shapeid::diagnosis
