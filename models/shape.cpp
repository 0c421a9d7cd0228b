// Shapes of all kinds: makers, and what is the same for every kind.
#include "shapeid/models/shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <type_traits>

#include "shapeid/models/cells.hpp"
#include "shapeid/models/polyhedron.hpp"

namespace shapeid {
namespace {

/// Kinds that are a cell of a canonical body under an affine map.
template <typename Kind>
concept Cellular = requires(const Kind& kind) {
  kind.frame;
  kind.cell;
};

Moments moments_of(const Cellular auto& shape) {
  const Moments canonical = canonical_moments(shape);
  const Eigen::Matrix3d L = shape.frame.linear();
  return {canonical.volume * L.determinant(), shape.frame * canonical.centroid,
          L * canonical.covariance * L.transpose()};
}
Moments moments_of(const Polyhedron& polyhedron) { return moments(polyhedron); }
Moments moments_of(const Point& point) {
  return {point.nominal_volume, point.position, Eigen::Matrix3d::Zero()};
}

Violation malformation(const Cellular auto& shape) {
  const auto& [lower, upper] = shape.cell;
  const Cell whole = whole_cell(shape);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(lower[axis] < upper[axis])) return fmt::format("its cell is empty along axis {}", axis);
    const bool inside = axis == turning_axis(shape)
                            ? upper[axis] - lower[axis] <= whole.upper[axis] - whole.lower[axis]
                            : whole.lower[axis] <= lower[axis] && upper[axis] <= whole.upper[axis];
    if (!inside) return fmt::format("its cell leaves the canonical body along axis {}", axis);
  }
  const Moments m = moments_of(shape);
  if (!shape.frame.matrix().allFinite() || !std::isfinite(m.volume) || !(m.volume > 0.0)) {
    return "its volume or pose is not a positive finite number";
  }
  return std::nullopt;
}
Violation malformation(const Polyhedron& polyhedron) { return why_malformed(polyhedron); }
Violation malformation(const Point& point) {
  const bool fine = point.position.allFinite() && std::isfinite(point.nominal_volume) &&
                    point.nominal_volume > 0.0;
  if (fine) return std::nullopt;
  return "a point needs a finite position and a positive finite nominal volume";
}

bool contained(const Cellular auto& shape, const Eigen::Vector3d& point, double slack) {
  const Eigen::Vector3d here = coordinates_of(shape, shape.frame.inverse() * point);
  const Eigen::Vector3d nearest = here.cwiseMax(shape.cell.lower).cwiseMin(shape.cell.upper);
  if (nearest == here) return true;
  return (shape.frame * canonical_point(shape, nearest) - point).norm() <= slack;
}
bool contained(const Polyhedron& polyhedron, const Eigen::Vector3d& point, double slack) {
  return contains(polyhedron, point, slack);
}
bool contained(const Point& shape, const Eigen::Vector3d& point, double slack) {
  return (shape.position - point).norm() <= slack;
}

using Corners = std::pair<Eigen::Vector3d, Eigen::Vector3d>;

Corners bounds_of(const Cellular auto& shape) {
  const Eigen::Matrix3d L = shape.frame.linear();
  Corners corners = {shape.frame.translation(), shape.frame.translation()};
  for (int axis = 0; axis < 3; ++axis) {
    corners.first[axis] -= support(shape, -L.row(axis).transpose());
    corners.second[axis] += support(shape, L.row(axis).transpose());
  }
  return corners;
}
Corners bounds_of(const Polyhedron& polyhedron) {
  Corners corners = {polyhedron.vertices.front(), polyhedron.vertices.front()};
  for (const Eigen::Vector3d& v : polyhedron.vertices) {
    corners.first = corners.first.cwiseMin(v);
    corners.second = corners.second.cwiseMax(v);
  }
  return corners;
}
Corners bounds_of(const Point& point) { return {point.position, point.position}; }

[[noreturn]] void refuse_thin() {
  throw std::invalid_argument("the shape is too thin to be divided in double precision");
}
[[noreturn]] void refuse_indivisible() {
  throw std::invalid_argument("points, and meshes that are not convex, cannot be divided");
}

std::pair<Shape, Shape> divide_across(const Cellular auto& shape, int axis, double fraction) {
  const double cut = cut_coordinate(shape, axis, fraction);
  if (!(shape.cell.lower[axis] < cut && cut < shape.cell.upper[axis])) refuse_thin();
  auto lower = shape;
  auto upper = shape;
  lower.cell.upper[axis] = cut;
  upper.cell.lower[axis] = cut;
  return {lower, upper};
}

std::pair<Shape, Shape> divide_across(const Polyhedron& polyhedron,
                                      const Eigen::Vector3d& direction, double fraction) {
  if (!polyhedron.convex) refuse_indivisible();
  auto parts = cut(polyhedron, direction, fraction);
  if (!parts) refuse_thin();
  return {std::move(parts->first), std::move(parts->second)};
}
std::pair<Shape, Shape> divide_across(const Polyhedron& polyhedron, int axis, double fraction) {
  return divide_across(polyhedron, Eigen::Vector3d::Unit(axis), fraction);
}
std::pair<Shape, Shape> divide_across(const Point&, int, double) { refuse_indivisible(); }

std::pair<Shape, Shape> halve(const Cellular auto& shape) {
  const Eigen::Vector3d sides = side_lengths(shape);
  const double long_enough = (1.0 - tie_of_sides) * sides.maxCoeff();
  int axis = 0;
  while (sides[axis] < long_enough) ++axis;
  return divide_across(shape, axis, 0.5);
}
std::pair<Shape, Shape> halve(const Polyhedron& polyhedron) {
  return divide_across(polyhedron, longest_direction(polyhedron), 0.5);
}
std::pair<Shape, Shape> halve(const Point&) { refuse_indivisible(); }

Shape checked(Shape shape) {
  if (const Violation why = why_malformed(shape)) {
    throw std::invalid_argument(fmt::format("{}: {}", kind_name(shape), *why));
  }
  return shape;
}

void demand_positive(const Eigen::Vector3d& size, const char* what) {
  if (size.allFinite() && (size.array() > 0.0).all()) return;
  throw std::invalid_argument(fmt::format("{} must be positive and finite, not {:g} {:g} {:g}",
                                          what, size[0], size[1], size[2]));
}

Eigen::Affine3d stretched(const Eigen::Isometry3d& pose, const Eigen::Vector3d& size) {
  return pose * Eigen::Scaling(size);
}

}  // namespace

Violation why_malformed(const Shape& shape) {
  return std::visit([](const auto& s) { return malformation(s); }, shape);
}

Shape make_cuboid(const Eigen::Vector3d& sides, const Eigen::Isometry3d& pose) {
  demand_positive(sides, "sides of a cuboid");
  return checked(Cuboid{stretched(pose, sides), whole_cell(Cuboid{})});
}

Shape make_cylinder(double radius, double length, const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d size(radius, radius, length);
  demand_positive(size, "radius, radius and length of a cylinder");
  return checked(Cylinder{stretched(pose, size), whole_cell(Cylinder{})});
}

Shape make_ellipsoid(const Eigen::Vector3d& semi_axes, const Eigen::Isometry3d& pose) {
  demand_positive(semi_axes, "semi-axes of an ellipsoid");
  return checked(Ellipsoid{stretched(pose, semi_axes), whole_cell(Ellipsoid{})});
}

Shape make_mesh(std::vector<Eigen::Vector3d> vertices, std::vector<std::array<int, 3>> faces,
                const Eigen::Isometry3d& pose) {
  for (Eigen::Vector3d& v : vertices) v = pose * v;
  Polyhedron polyhedron{std::move(vertices), {}};
  for (const auto& face : faces) polyhedron.sides.emplace_back(face.begin(), face.end());
  if (const Violation why = why_malformed(polyhedron)) {
    throw std::invalid_argument(fmt::format("mesh: {}", *why));
  }
  polyhedron.convex = is_convex(polyhedron);
  return polyhedron;
}

Shape make_point(const Eigen::Vector3d& position, double nominal_volume) {
  return checked(Point{position, nominal_volume});
}

std::string kind_name(const Shape& shape) {
  constexpr std::array names = {"cuboid", "cylinder", "ellipsoid", "polyhedron", "point"};
  static_assert(names.size() == std::variant_size_v<Shape>);
  return names[shape.index()];
}

Moments moments(const Shape& shape) {
  return std::visit([](const auto& s) { return moments_of(s); }, shape);
}

double volume(const Shape& shape) { return moments(shape).volume; }

InertialParameters unit_parameters(const Shape& shape) {
  SHAPEID_CONTRACT(why_malformed(shape));
  const Moments m = moments(shape);
  const Eigen::Matrix3d I = m.covariance.trace() * Eigen::Matrix3d::Identity() - m.covariance;
  return from_centre(1.0, m.centroid, I);
}

bool contains(const Shape& shape, const Eigen::Vector3d& point, double slack) {
  return std::visit([&](const auto& s) { return contained(s, point, slack); }, shape);
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> bounds(const Shape& shape) {
  return std::visit([](const auto& s) { return bounds_of(s); }, shape);
}

bool divisible(const Shape& shape) {
  if (const auto* polyhedron = std::get_if<Polyhedron>(&shape)) return polyhedron->convex;
  return !std::holds_alternative<Point>(shape);
}

std::pair<Shape, Shape> divide(const Shape& shape, int axis, double fraction) {
  if (axis < 0 || axis > 2) throw std::invalid_argument(fmt::format("there is no axis {}", axis));
  if (!(0.0 < fraction && fraction < 1.0)) {
    throw std::invalid_argument(fmt::format("{:g} is not a fraction between 0 and 1", fraction));
  }
  return std::visit([&](const auto& s) { return divide_across(s, axis, fraction); }, shape);
}

std::pair<Shape, Shape> divide(const Shape& shape) {
  return std::visit([](const auto& s) { return halve(s); }, shape);
}

std::optional<std::pair<Shape, Shape>> parts_if_any(const Shape& shape) {
  try {
    return divide(shape);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

}  // namespace shapeid
