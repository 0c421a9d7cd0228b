// Whether the columns of U are what the declared shapes make, and the shapes lie in the regions.
#pragma once

#include "shapeid/models/stated_problem.hpp"
#include "shapeid/proofs/certificate/rational.hpp"

namespace shapeid::certificate {

struct Geometry {
  Eigen::Index declared = 0;       ///< columns whose shape is stated
  Eigen::Index agree = 0;          ///< of these, columns and volumes that are the shape's
  Eigen::Index inside = 0;         ///< shapes that are shown to lie in one region of their link
  std::string first_disagreement;  ///< a sentence; empty if all agree
};

/// Columns and volumes are compared with exact moments up to `rounding`, relative to one, to the
/// root mean square distance from the link's origin and to its square. A part of a region's own
/// cell is inside if its bounds are; corners and points are tested against the region's planes, or
/// the ball or cylinder in its frame, with the region widened by `rounding`. Curved shapes in
/// regions of another frame or kind, and any in sectors or meshes that are not convex, are not
/// shown.
[[nodiscard]] Geometry check_geometry(const StatedProblem& problem, const Rational& rounding);

}  // namespace shapeid::certificate
