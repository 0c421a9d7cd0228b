// Ellipsoids: sectors in r, polar angle, azimuth of the unit ball, down to slivers.
#include <cmath>
#include <numbers>

#include "shapeid/models/arc.hpp"
#include "shapeid/models/cells.hpp"

namespace shapeid {
namespace {

using std::numbers::pi;

/// Radius with weight r^2 over [lower, upper]; m the middle, q the square of the width.
struct RadiusInBall {
  double m, q, width;

  explicit RadiusInBall(const Cell& cell)
      : m(0.5 * (cell.lower[0] + cell.upper[0])), width(cell.upper[0] - cell.lower[0]) {
    q = width * width;
  }
  [[nodiscard]] double mean_weight() const { return m * m + q / 12.0; }
  [[nodiscard]] double weight() const { return width * mean_weight(); }
  [[nodiscard]] double mean() const { return m * (m * m + q / 4.0) / mean_weight(); }
  [[nodiscard]] double variance() const {
    const double m2 = m * m;
    return q * (m2 * m2 / 12.0 - m2 * q / 120.0 + q * q / 960.0) / (mean_weight() * mean_weight());
  }
};

/// (s, c) = (sin, cos) of the polar angle with weight sin over [lower, upper].
struct Polar {
  double weight;             ///< integral of sin
  Eigen::Vector2d mean;      ///< of (s, c)
  Eigen::Matrix2d variance;  ///< covariance of (s, c)

  explicit Polar(const Cell& cell);
  /// mean of (s, c)(s, c)^T
  [[nodiscard]] Eigen::Matrix2d mean_square() const { return variance + mean * mean.transpose(); }
};

Polar::Polar(const Cell& cell) {
  const double lower = cell.lower[1];
  const double upper = cell.upper[1];
  const double h = 0.5 * (upper - lower);
  const double S = std::sin(h);
  // A narrow cell near the far pole has a middle that rounds; the sines of its ends do not.
  const double sin_middle = h < pi / 4.0 ? (std::sin(lower) + std::sin(upper)) / (2.0 * std::cos(h))
                                         : std::sin(lower + h);
  const double cos_middle = std::cos(lower + h);
  const double cot_middle = cos_middle / sin_middle;

  // Angle u from the middle, weight sin(middle + u); d = 1 - cos u and b = sin u are small where
  // the cell is narrow, so their moments keep their digits. Integrals over [-h, h]:
  const auto d_cos = -alternating_series(h, 1, 1, [](int k) { return std::pow(4.0, k) - 2.0; });
  const auto dd_cos = alternating_series(
      h, 2, 1, [](int k) { return 3.5 - 2.0 * std::pow(4.0, k) + 0.5 * std::pow(9.0, k); });
  const auto sin2 = h * sinc_defect(2.0 * h);
  const auto d_sin2 = alternating_series(
      h, 2, 1, [](int k) { return 0.5 * std::pow(9.0, k) - std::pow(4.0, k) - 0.5; });

  const double mean_d = d_cos / (2.0 * S);
  const double mean_b = cot_middle * sin2 / (2.0 * S);
  const double variance_d = dd_cos / (2.0 * S) - mean_d * mean_d;
  const double variance_b = S * S / 3.0 - mean_b * mean_b;
  const double covariance_db = cot_middle * d_sin2 / (2.0 * S) - mean_d * mean_b;

  // s = sin(middle) (1 - d) + cos(middle) b,  c = cos(middle) (1 - d) - sin(middle) b.
  Eigen::Matrix2d of_db;
  of_db << -sin_middle, cos_middle, -cos_middle, -sin_middle;
  Eigen::Matrix2d variance_db;
  variance_db << variance_d, covariance_db, covariance_db, variance_b;

  weight = 2.0 * sin_middle * S;
  mean << sin_middle * (1.0 - mean_d) + cos_middle * mean_b, cos_middle * std::cos(h);
  variance = of_db * variance_db * of_db.transpose();
}

/// Mean of w w^T for w = (p cos t, p sin t, q), from the mean of (p, q)(p, q)^T; t has a symmetric
/// arc, so that nothing correlates with y.
Eigen::Matrix3d swept(const Eigen::Matrix2d& pq, const Arc& arc) {
  Eigen::Matrix3d result =
      Eigen::Vector3d(pq(0, 0) * arc.mean_cos2(), pq(0, 0) * arc.mean_sin2(), pq(1, 1))
          .asDiagonal();
  result(0, 2) = result(2, 0) = pq(0, 1) * arc.mean_cos();
  return result;
}

}  // namespace

Cell whole_cell(const Ellipsoid&) { return {{0.0, 0.0, 0.0}, {1.0, pi, 2.0 * pi}}; }

Moments canonical_moments(const Ellipsoid& ellipsoid) {
  const auto& [lower, upper] = ellipsoid.cell;
  const RadiusInBall r(ellipsoid.cell);
  const Polar polar(ellipsoid.cell);
  const Arc arc(lower[2], upper[2]);

  // Points are r n with r independent of n = (s cos t, s sin t, c), in axes whose x points along
  // the middle of the azimuths.
  const double s = polar.mean[0];
  const Eigen::Vector3d mean_n(s * arc.mean_cos(), 0.0, polar.mean[1]);
  const Eigen::Matrix3d mean_nnT = swept(polar.mean_square(), arc);
  Eigen::Matrix3d variance_n = swept(polar.variance, arc);
  variance_n(0, 0) += s * s * arc.variance_cos();
  variance_n(1, 1) += s * s * arc.mean_sin2();

  const Eigen::Matrix3d R = about_z(arc.middle);
  return {r.weight() * polar.weight * 2.0 * arc.half, R * (r.mean() * mean_n),
          R * (r.variance() * mean_nnT + r.mean() * r.mean() * variance_n) * R.transpose()};
}

double cut_coordinate(const Ellipsoid& ellipsoid, int axis, double fraction) {
  const double a = ellipsoid.cell.lower[axis];
  const double b = ellipsoid.cell.upper[axis];
  if (axis == 2) return a + fraction * (b - a);
  if (axis == 0) {
    // r^3 is uniform. The step from a is what must be exact: divide the difference of cubes.
    const double step = fraction * (b - a) * (a * a + a * b + b * b);
    const double cut = std::cbrt(a * a * a + step);
    return a + step / (cut * cut + cut * a + a * a);
  }
  // The cosine is uniform, hence so are the squares of sine and cosine of half the angle: one of
  // them is small near either pole, and keeps its digits.
  const auto between = [&](double at_a, double at_b) {
    return std::sqrt((1.0 - fraction) * at_a * at_a + fraction * at_b * at_b);
  };
  return 2.0 * std::atan2(between(std::sin(0.5 * a), std::sin(0.5 * b)),
                          between(std::cos(0.5 * a), std::cos(0.5 * b)));
}

Eigen::Vector3d side_lengths(const Ellipsoid& ellipsoid) {
  const auto& [lower, upper] = ellipsoid.cell;
  const Arc arc(lower[2], upper[2]);
  const Eigen::Matrix2d square = Polar(ellipsoid.cell).mean_square();
  const Eigen::Matrix3d linear = ellipsoid.frame.linear() * about_z(arc.middle);

  Eigen::Matrix2d turned;  // of (c, -s)
  turned << square(1, 1), -square(0, 1), -square(0, 1), square(0, 0);
  // Means of e e^T for the unit vectors e along r, polar angle, azimuth.
  const Eigen::Matrix3d outward = swept(square, arc);
  const Eigen::Matrix3d down = swept(turned, arc);
  const Eigen::Matrix3d around =
      Eigen::Vector3d(arc.mean_sin2(), arc.mean_cos2(), 0.0).asDiagonal();
  const double widest = largest_on_arc(0.0, 1.0, lower[1], upper[1]);  // sine of the polar angle
  return {(upper[0] - lower[0]) * rms_stretch(linear, outward),
          upper[0] * (upper[1] - lower[1]) * rms_stretch(linear, down),
          upper[0] * widest * 2.0 * arc.half * rms_stretch(linear, around)};
}

Eigen::Vector3d coordinates_of(const Ellipsoid& ellipsoid, const Eigen::Vector3d& point) {
  const auto& [lower, upper] = ellipsoid.cell;
  const double across = std::hypot(point.x(), point.y());
  return {std::hypot(across, point.z()), std::atan2(across, point.z()),
          turned_to(std::atan2(point.y(), point.x()), lower[2], upper[2])};
}

Eigen::Vector3d canonical_point(const Ellipsoid&, const Eigen::Vector3d& coordinates) {
  const double across = coordinates[0] * std::sin(coordinates[1]);
  return {across * std::cos(coordinates[2]), across * std::sin(coordinates[2]),
          coordinates[0] * std::cos(coordinates[1])};
}

double support(const Ellipsoid& ellipsoid, const Eigen::Vector3d& direction) {
  const auto& [lower, upper] = ellipsoid.cell;
  const double across = largest_on_arc(direction.x(), direction.y(), lower[2], upper[2]);
  const double outward = largest_on_arc(direction.z(), across, lower[1], upper[1]);
  return std::max(outward * lower[0], outward * upper[0]);
}

}  // namespace shapeid
