// Cylinders: sectors in r, angle, z of the unit cylinder, down to slivers.
#include <cmath>
#include <numbers>

#include "shapeid/models/arc.hpp"
#include "shapeid/models/cells.hpp"

namespace shapeid {
namespace {

/// Radius with weight r over [lower, upper].
struct RadiusInDisc {
  double middle, width;

  explicit RadiusInDisc(const Cell& cell)
      : middle(0.5 * (cell.lower[0] + cell.upper[0])), width(cell.upper[0] - cell.lower[0]) {}
  [[nodiscard]] double weight() const { return middle * width; }
  [[nodiscard]] double mean() const { return middle + width * width / (12.0 * middle); }
  [[nodiscard]] double mean_square() const { return middle * middle + width * width / 4.0; }
  [[nodiscard]] double variance() const {
    const double q = width * width;
    return q / 12.0 * (1.0 - q / (12.0 * middle * middle));
  }
};

}  // namespace

Cell whole_cell(const Cylinder&) { return {{0.0, 0.0, -0.5}, {1.0, 2.0 * std::numbers::pi, 0.5}}; }

Moments canonical_moments(const Cylinder& cylinder) {
  const auto& [lower, upper] = cylinder.cell;
  const RadiusInDisc r(cylinder.cell);
  const Arc arc(lower[1], upper[1]);
  const double height = upper[2] - lower[2];

  // In axes whose x points along the middle of the arc the sector is symmetric about the x axis.
  const Eigen::Vector3d centre(r.mean() * arc.mean_cos(), 0.0, 0.5 * (lower[2] + upper[2]));
  const Eigen::Vector3d spread(
      r.variance() * arc.mean_cos2() + r.mean() * r.mean() * arc.variance_cos(),
      r.mean_square() * arc.mean_sin2(), height * height / 12.0);
  const Eigen::Matrix3d R = about_z(arc.middle);
  return {r.weight() * 2.0 * arc.half * height, R * centre,
          R * spread.asDiagonal() * R.transpose()};
}

double cut_coordinate(const Cylinder& cylinder, int axis, double fraction) {
  const auto& [lower, upper] = cylinder.cell;
  const double a = lower[axis];
  const double width = upper[axis] - a;
  if (axis != 0) return a + fraction * width;
  // r^2 is uniform. The step from a is what must be exact, so the difference of roots is expanded.
  const double step = fraction * width * (upper[0] + a);
  return a + step / (a + std::sqrt(a * a + step));
}

Eigen::Vector3d side_lengths(const Cylinder& cylinder) {
  const auto& [lower, upper] = cylinder.cell;
  const Arc arc(lower[1], upper[1]);
  const Eigen::Matrix3d linear = cylinder.frame.linear() * about_z(arc.middle);
  const Eigen::Vector3d radial(arc.mean_cos2(), arc.mean_sin2(), 0.0);
  const Eigen::Vector3d around(arc.mean_sin2(), arc.mean_cos2(), 0.0);
  return {(upper[0] - lower[0]) * rms_stretch(linear, radial.asDiagonal()),
          upper[0] * 2.0 * arc.half * rms_stretch(linear, around.asDiagonal()),
          (upper[2] - lower[2]) * linear.col(2).norm()};
}

Eigen::Vector3d coordinates_of(const Cylinder& cylinder, const Eigen::Vector3d& point) {
  const auto& [lower, upper] = cylinder.cell;
  return {std::hypot(point.x(), point.y()),
          turned_to(std::atan2(point.y(), point.x()), lower[1], upper[1]), point.z()};
}

Eigen::Vector3d canonical_point(const Cylinder&, const Eigen::Vector3d& coordinates) {
  const double r = coordinates[0];
  return {r * std::cos(coordinates[1]), r * std::sin(coordinates[1]), coordinates[2]};
}

double support(const Cylinder& cylinder, const Eigen::Vector3d& direction) {
  const auto& [lower, upper] = cylinder.cell;
  const double outward = largest_on_arc(direction.x(), direction.y(), lower[1], upper[1]);
  return std::max(outward * lower[0], outward * upper[0]) +
         std::max(direction.z() * lower[2], direction.z() * upper[2]);
}

}  // namespace shapeid
