// Where a load of a link may be: every body is points of mass, and these are sought one by one.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/diagnosis/regions.hpp"

namespace shapeid::diagnosis {

/// m: how far beyond its link a load may have its mass.
inline constexpr double furthest_load = 1.0;

/// `furthest_load` on every side beyond the link's origin, its given centre of mass and the origins
/// of its children.
[[nodiscard]] Box room_for_load(const Robot& robot, int link);

/// Points to begin with: corners, sides and inside of the room, most of them where the link is.
[[nodiscard]] std::vector<Eigen::Vector3d> first_places(const Box& room);

struct SteepestPlace {
  Eigen::Vector3d place;
  double slope;  ///< what a unit of mass there adds to the objective
};

/// The point of the room at which a little mass would lower an objective most: `gradient` is that
/// by the load's ten parameters. From the best of the first places down, axis by axis.
[[nodiscard]] SteepestPlace steepest_place(const Eigen::VectorXd& gradient, const Box& room);

}  // namespace shapeid::diagnosis
