#include "shapeid/models/arc.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace shapeid {

using std::numbers::pi;

double sinc_defect(double x) {
  // Beyond half a turn sin(x) / x is small or negative, and nothing cancels.
  if (std::abs(x) > pi) return 1.0 - std::sin(x) / x;
  return -alternating_series(x, 1, 1, [](int) { return 1.0; }) / x;
}

Arc::Arc(double lower, double upper) : middle(0.5 * (lower + upper)), half(0.5 * (upper - lower)) {}

double Arc::mean_cos() const { return std::sin(half) / half; }

double Arc::mean_cos2() const { return 1.0 - mean_sin2(); }

double Arc::mean_sin2() const { return 0.5 * sinc_defect(2.0 * half); }

double Arc::variance_cos() const {
  const double x = 2.0 * half;
  return -alternating_series(x, 3, 0, [](int k) { return k - 2.0; }) / (x * x);
}

Eigen::Matrix3d about_z(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

double largest_on_arc(double a, double b, double lower, double upper) {
  const double best = turned_to(std::atan2(b, a), lower, upper);
  if (lower <= best && best <= upper) return std::hypot(a, b);
  return std::max(a * std::cos(lower) + b * std::sin(lower),
                  a * std::cos(upper) + b * std::sin(upper));
}

double turned_to(double angle, double lower, double upper) {
  const double turns = std::round((0.5 * (lower + upper) - angle) / (2.0 * pi));
  return angle + 2.0 * pi * turns;
}

}  // namespace shapeid
