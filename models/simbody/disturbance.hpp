// What acts on a simulated robot beyond its model: friction, springs, pulls. No Simbody header
// here.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace shapeid {

/// What a disturbance may depend on. World axes, z up.
struct DisturbedState {
  double time = 0.0;
  Eigen::VectorXd q, dq;                  ///< n
  Eigen::VectorXd drive;                  ///< torques of the drives, N m, n
  std::vector<Eigen::Matrix3d> attitude;  ///< of each link, link to world
  std::vector<Eigen::Vector3d> velocity;  ///< of each link's origin, m/s
};

struct DisturbingForces {
  Eigen::VectorXd joint;              ///< N m, n, besides the drives'
  std::vector<Eigen::Vector3d> link;  ///< N, at each link's origin
};

/// Adds to forces that are zero when it is called. Empty: nothing disturbs.
using Disturbance = std::function<void(const DisturbedState&, DisturbingForces&)>;

}  // namespace shapeid
