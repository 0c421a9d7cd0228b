// A block fixed to a robot: the unknown load of the examples and tests.
#pragma once

#include <Eigen/Core>

#include "shapeid/models/robot.hpp"

namespace shapeid {

/// A block of uniform density, its sides along the axes of the link that carries it.
struct Load {
  int link = 0;
  double mass = 1.0;                                          ///< kg
  Eigen::Vector3d sides = Eigen::Vector3d::Constant(0.04);    ///< m
  Eigen::Vector3d centre = Eigen::Vector3d(0.0, 0.0, 0.078);  ///< m, link frame
};

[[nodiscard]] InertialParameters inertia_of(const Load& load);

/// The robot with the block welded on: the link's inertia and collision bodies grow.
[[nodiscard]] Robot with_load(const Robot& robot, const Load& load);

}  // namespace shapeid
