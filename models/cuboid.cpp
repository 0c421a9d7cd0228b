// Cuboids: the cell in x, y, z is itself a box.
#include "shapeid/models/cells.hpp"

namespace shapeid {

Cell whole_cell(const Cuboid&) {
  return {Eigen::Vector3d::Constant(-0.5), Eigen::Vector3d::Constant(0.5)};
}

Moments canonical_moments(const Cuboid& cuboid) {
  const auto& [lower, upper] = cuboid.cell;
  const Eigen::Vector3d width = upper - lower;
  return {width.prod(), 0.5 * (lower + upper),
          (width.array().square() / 12.0).matrix().asDiagonal()};
}

double cut_coordinate(const Cuboid& cuboid, int axis, double fraction) {
  const auto& [lower, upper] = cuboid.cell;
  return lower[axis] + fraction * (upper[axis] - lower[axis]);
}

Eigen::Vector3d side_lengths(const Cuboid& cuboid) {
  const Eigen::Vector3d stretch = cuboid.frame.linear().colwise().norm();
  return stretch.cwiseProduct(cuboid.cell.upper - cuboid.cell.lower);
}

Eigen::Vector3d coordinates_of(const Cuboid&, const Eigen::Vector3d& point) { return point; }

Eigen::Vector3d canonical_point(const Cuboid&, const Eigen::Vector3d& coordinates) {
  return coordinates;
}

double support(const Cuboid& cuboid, const Eigen::Vector3d& direction) {
  const auto& [lower, upper] = cuboid.cell;
  return direction.cwiseProduct(lower).cwiseMax(direction.cwiseProduct(upper)).sum();
}

}  // namespace shapeid
