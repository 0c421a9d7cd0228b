// Arbitrary shapes, and points inside them by a way of their own.
#pragma once

#include <rapidcheck.h>

#include <ostream>

#include "shapeid/models/shape.hpp"

namespace shapeid {

/// What rapidcheck prints of a counterexample.
void showValue(const Shape& shape, std::ostream& out);

}  // namespace shapeid

namespace shapeid::test {

/// Cells of every width from the whole body down to 1e-4 of it per axis, touching the bounds of the
/// canonical body or not, in frames that are rotated, off the origin, stretched and sheared.
[[nodiscard]] rc::Gen<Shape> cuboid_cell();
[[nodiscard]] rc::Gen<Shape> cylinder_sector();
[[nodiscard]] rc::Gen<Shape> ellipsoid_sector();

/// The hull of 4 to 20 arbitrary points, in an arbitrary frame of the same sort.
[[nodiscard]] rc::Gen<Shape> convex_polyhedron();

/// Any of the above.
[[nodiscard]] rc::Gen<Shape> solid();

/// A division that need not be the default one, and the part to go on with.
struct Cut {
  int axis;
  double fraction;
  bool upper;
};
[[nodiscard]] rc::Gen<Cut> cut();
void showValue(const Cut& cut, std::ostream& out);

/// Three numbers well inside (0, 1), for point_inside().
[[nodiscard]] rc::Gen<Eigen::Vector3d> whereabouts();

/// A point strictly inside a convex solid: its coordinates as fractions of the cell's, or for a
/// polyhedron a face, a place on it, and how far from the centroid to there. Not evenly spread.
[[nodiscard]] Eigen::Vector3d point_inside(const Shape& shape, const Eigen::Vector3d& where);

/// The same shape under an affine map of the link frame.
[[nodiscard]] Shape mapped(const Shape& shape, const Eigen::Affine3d& map);

/// Distance of the farthest corner of the bounding box from the link origin, m: positions cannot be
/// better than eps times this.
[[nodiscard]] double reach(const Shape& shape);

/// Root mean square distance from the centroid, m: what a part's own size is measured by.
[[nodiscard]] double own_size(const Shape& shape);

/// What eps is relative to in a volume, over the volume: 1 for cells. Vertices of polyhedra round
/// at their distance from the link origin, which counts the more the thinner the solid is.
[[nodiscard]] double volume_rounding(const Shape& shape);

}  // namespace shapeid::test
