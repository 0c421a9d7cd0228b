// Where a quadratic polynomial is lowest on the regions of a link.
#pragma once

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/inertia.hpp"

namespace shapeid::experiments {

struct LowestPoint {
  double value;           ///< the polynomial is nowhere below this in the regions, rounding aside
  Eigen::Vector3d point;  ///< m, link frame, where it has this value
};

/// Of z . pi(x), with pi(x) the parameters of a unit point at x. Regions are whole cuboids and
/// cylinders; a cylinder counts as the prism of 48 sides around it. Throws std::invalid_argument
/// for other shapes.
[[nodiscard]] LowestPoint lowest_point(const BodyModel& regions, const Vector10& z);

}  // namespace shapeid::experiments
