// Means of trigonometric functions over an interval of angles, free of cancellation however narrow
// the interval is (docs/derivations/shapes.md, "Arcs").
#pragma once

#include <Eigen/Core>

namespace shapeid {

/// 1 - sin(x) / x, to full relative precision.
[[nodiscard]] double sinc_defect(double x);

/// sum over k >= first of (-1)^k c(k) x^n / n!  with n = 2 k + parity, until it stands still: for
/// functions whose leading Taylor terms cancel. |x| up to one turn, c(k) growing like 9^k at most.
template <typename Coefficient>
[[nodiscard]] double alternating_series(double x, int first, int parity, Coefficient c) {
  constexpr int most_terms = 60;  // (3/4 turn)^n / n! and (1 turn)^n / n! vanish well before
  double power = first % 2 == 0 ? 1.0 : -1.0;  // (-1)^k x^n / n!
  for (int n = 1; n <= 2 * first + parity; ++n) power *= x / n;
  double sum = 0.0;
  for (int k = first; k < most_terms; ++k) {
    const double next = sum + c(k) * power;
    if (next == sum) break;
    sum = next;
    const int n = 2 * k + parity;
    power *= -x * x / ((n + 1.0) * (n + 2.0));
  }
  return sum;
}

/// Angles t uniform in [-half, half] around `middle`; means are of functions of t.
struct Arc {
  double middle, half;  ///< rad, half in (0, pi]

  Arc(double lower, double upper);
  [[nodiscard]] double mean_cos() const;
  [[nodiscard]] double mean_cos2() const;
  [[nodiscard]] double mean_sin2() const;
  /// mean of cos^2 t minus the square of the mean of cos t
  [[nodiscard]] double variance_cos() const;
};

/// Rotation by `angle` about z: from axes that start at the middle of an arc to canonical ones.
[[nodiscard]] Eigen::Matrix3d about_z(double angle);

/// The largest value of a cos t + b sin t for t in [lower, upper].
[[nodiscard]] double largest_on_arc(double a, double b, double lower, double upper);

/// `angle` plus the number of whole turns that brings it nearest to the middle of [lower, upper].
[[nodiscard]] double turned_to(double angle, double lower, double upper);

}  // namespace shapeid
