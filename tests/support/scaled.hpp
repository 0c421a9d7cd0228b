// Scaled residuals: an error counts only against the size of what was computed and the machine
// epsilon, never against a number picked to make a test pass.
#pragma once

#include <Eigen/Core>

#include <cmath>

namespace shapeid::test {

/// || error || / (scale x eps x size): how many roundings of the computation's own size the error
/// amounts to. `scale` is a norm of the operands, `size` the length of the sums involved.
[[nodiscard]] double scaled(double error, double scale, Eigen::Index size);

/// || a - b || scaled by the larger of their norms.
[[nodiscard]] double scaled_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                       Eigen::Index size);

/// The larger of the two, and NaN for good once there was one: std::max(worst, NaN) is `worst`.
inline void keep_worst(double& worst, double here) {
  if (!std::isnan(worst) && !(here <= worst)) worst = here;
}

/// The one threshold for backward stable computations of our sizes. LAPACK's testers use 30 for a
/// single factorisation; ours chain up to ten such steps (twenty links, a few frames each).
inline constexpr double few_hundred_eps = 300.0;

}  // namespace shapeid::test
