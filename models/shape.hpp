// Claim C6. Primitive shapes of uniform density, placed in a link frame: volume, moments up to
// order two, division into two shapes of the same kind.
//
// Cuboids, cylinders and ellipsoids are cells of a canonical body under an affine map, so one
// formula per canonical body serves for all poses, sizes and parts: moments are integrated in
// canonical coordinates and mapped by Sigma -> T Sigma T^T (docs/derivations/shapes.md). Division
// moves a bound of the cell and nothing else, so that parts do not drift however often they are
// divided.
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "shapeid/models/contract.hpp"
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

/// A closed surface of plane sides, each a loop of vertices, counter-clockwise seen from outside,
/// in link coordinates (m). A mesh and a hull have a side for each triangle; a cut shortens sides
/// or takes them away, and adds one. Convex solids divide; a closed mesh that is not convex is
/// allowed, and refuses to divide.
struct Polyhedron {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::vector<int>> sides;
  bool convex = true;
};

/// A point mass. It has no volume of its own and is given a nominal one; it does not divide.
struct Point {
  Eigen::Vector3d position;  ///< m
  double nominal_volume;     ///< m^3
};

using Shape = std::variant<Cuboid, Cylinder, Ellipsoid, Polyhedron, Point>;

/// Empty if the shape is one that the functions below are defined for: finite, of positive volume,
/// the cell inside its canonical body, the surface closed and counter-clockwise.
[[nodiscard]] Violation why_malformed(const Shape& shape);

/// Makers: size in m, pose in the link frame. Each throws std::invalid_argument for sizes that are
/// not positive and finite, points without a solid hull, and surfaces that are open, inconsistently
/// oriented or inside out (a mesh is never turned silently). A mesh is marked convex if no edge is
/// re-entrant by more than single precision, which is what mesh files usually carry.
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

/// Volume, centroid and central covariance of a uniform solid (10). The covariance is about the
/// centroid, so that a small part keeps its digits however far it lies from the link origin.
struct Moments {
  double volume;               ///< m^3; the nominal one for a point
  Eigen::Vector3d centroid;    ///< m, link frame
  Eigen::Matrix3d covariance;  ///< m^2, mean of (x - centroid)(x - centroid)^T, link axes
};

[[nodiscard]] Moments moments(const Shape& shape);

/// m^3
[[nodiscard]] double volume(const Shape& shape);

/// Equations (10)-(13): the ten parameters of the shape with unit mass and uniform density, about
/// the link origin in link axes. Times its mass this is the shape's share of the link's Phi (14).
[[nodiscard]] InertialParameters unit_parameters(const Shape& shape);

/// The surface in triangles: each side fanned from its first vertex.
[[nodiscard]] std::vector<std::array<int, 3>> triangles(const Polyhedron& polyhedron);

/// Whether a point of the link frame lies inside or on the boundary. With slack (m), also whether
/// the point of the shape with the nearest coordinates of its cell is no farther away than that.
[[nodiscard]] bool contains(const Shape& shape, const Eigen::Vector3d& point, double slack = 0.0);

/// Axis-aligned bounds in link axes, lower and upper corner, m.
[[nodiscard]] std::pair<Eigen::Vector3d, Eigen::Vector3d> bounds(const Shape& shape);

/// Whether divide() can be called. A point cannot be divided, nor a mesh that is not convex.
[[nodiscard]] bool divisible(const Shape& shape);

/// Cuts across coordinate `axis` (0, 1, 2 of the cell; of the link axes for a polyhedron) so that
/// the first part, on the lower side, holds `fraction` of the volume. Both parts are of the same
/// kind. Throws std::invalid_argument if the shape is not divisible, the axis is none of the three,
/// the fraction is not between 0 and 1, or the parts would be thinner than one rounding.
[[nodiscard]] std::pair<Shape, Shape> divide(const Shape& shape, int axis, double fraction);

/// Sides whose lengths differ by less than this fraction count as equally long: what rounding makes
/// of equal sides must not decide where the next cut goes.
inline constexpr double tie_of_sides = 1e-9;

/// Algorithm 1's cut: into equal volumes, across the longest side. Sides of a cell are measured in
/// metres: straight ones as they are, arcs at their largest radius, in a stretched frame by the
/// root mean square of the stretch along the coordinate. A polyhedron is cut across its principal
/// direction of largest spread. Of sides that tie the one of the lowest axis is cut.
[[nodiscard]] std::pair<Shape, Shape> divide(const Shape& shape);
/// The same of a divisible shape, but none of a mesh that is too thin to be cut in double
/// precision, as only the cut tells.
[[nodiscard]] std::optional<std::pair<Shape, Shape>> parts_if_any(const Shape& shape);

}  // namespace shapeid
