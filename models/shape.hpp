// Primitive shapes of uniform density, placed in a link frame: volume, moments up to order two,
// division into two shapes of the same kind.
//
// Every solid is a cell of a canonical body under an affine map, so one formula per canonical body
// serves for all poses, sizes and parts: moments are integrated in canonical coordinates and mapped
// by Sigma -> T Sigma T^T (docs/derivations/shapes.md).
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "shapeid/models/inertia.hpp"

namespace shapeid {

/// Lower and upper bounds of a cell in the canonical coordinates of its kind.
struct Cell {
  Eigen::Vector3d lower, upper;
};

/// [-1/2, 1/2]^3 mapped by `frame`, whose linear part carries the sides. The cell is in x, y, z.
struct Cuboid {
  Eigen::Affine3d frame;
  Cell cell;
};

/// The unit cylinder (radius 1, z in [-1/2, 1/2]) mapped by `frame`. The cell is in r (0 to 1),
/// angle (rad, at most one turn), z.
struct Cylinder {
  Eigen::Affine3d frame;
  Cell cell;
};

/// The unit ball mapped by `frame`. The cell is in r (0 to 1), polar angle from +z (0 to pi),
/// azimuth (rad, at most one turn).
struct Ellipsoid {
  Eigen::Affine3d frame;
  Cell cell;
};

/// A closed surface of triangles, counter-clockwise seen from outside, in link coordinates (m).
/// Convex solids divide; a closed mesh that is not convex is allowed, and refuses to divide.
struct Polyhedron {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> faces;
  bool convex = true;
};

/// A point mass. It has no volume of its own and is given a nominal one; it does not divide.
struct Point {
  Eigen::Vector3d position;  ///< m
  double nominal_volume;     ///< m^3
};

using Shape = std::variant<Cuboid, Cylinder, Ellipsoid, Polyhedron, Point>;

/// Makers: size in m, pose in the link frame. Each throws std::invalid_argument for sizes that are
/// not positive and finite, or surfaces that are not closed.
[[nodiscard]] Shape make_cuboid(const Eigen::Vector3d& sides, const Eigen::Isometry3d& pose);
[[nodiscard]] Shape make_cylinder(double radius, double length, const Eigen::Isometry3d& pose);
[[nodiscard]] Shape make_ellipsoid(const Eigen::Vector3d& semi_axes, const Eigen::Isometry3d& pose);
[[nodiscard]] Shape make_convex_hull(const std::vector<Eigen::Vector3d>& points,
                                     const Eigen::Isometry3d& pose);
[[nodiscard]] Shape make_mesh(std::vector<Eigen::Vector3d> vertices,
                              std::vector<std::array<int, 3>> faces, const Eigen::Isometry3d& pose);
[[nodiscard]] Shape make_point(const Eigen::Vector3d& position, double nominal_volume);

/// "cuboid", "cylinder", "ellipsoid", "polyhedron", "point"
[[nodiscard]] std::string kind_name(const Shape& shape);

/// m^3
[[nodiscard]] double volume(const Shape& shape);

/// Equations (10)-(14): the ten parameters of the shape with unit mass and uniform density, about
/// the link origin in link axes. Times its mass this is the shape's share of the link's Phi.
[[nodiscard]] InertialParameters unit_parameters(const Shape& shape);

/// Whether a point of the link frame lies inside or on the boundary, to within `slack` (m).
[[nodiscard]] bool contains(const Shape& shape, const Eigen::Vector3d& point, double slack = 0.0);

/// Axis-aligned bounds in link axes, lower and upper corner, m.
[[nodiscard]] std::pair<Eigen::Vector3d, Eigen::Vector3d> bounds(const Shape& shape);

/// Whether divide() can be called. A point cannot be divided, nor a mesh that is not convex.
[[nodiscard]] bool divisible(const Shape& shape);

/// Cuts across coordinate `axis` (0, 1, 2 of the cell; of the bounding box for a polyhedron) so
/// that the first part holds `fraction` of the volume. Both parts are of the same kind.
[[nodiscard]] std::pair<Shape, Shape> divide(const Shape& shape, int axis, double fraction);

/// Algorithm 1's cut: into equal volumes, across the longest side (arc lengths for curved kinds,
/// the direction of largest spread for a polyhedron). Ties go to the lowest axis.
[[nodiscard]] std::pair<Shape, Shape> divide(const Shape& shape);

}  // namespace shapeid
