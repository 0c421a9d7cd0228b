// What given inertial parameters take: Y Phi without Y.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/fast/kinematics.hpp"
#include "shapeid/models/robot.hpp"

namespace shapeid::fast {

/// The same vector as `reference::regressor(robot, sample) * Phi`: equation (2) by one recursive
/// Newton-Euler sweep over the links that have parameters, or carry such links.
class InverseDynamics {
 public:
  /// `Phi`: 10 per link of the robot, stacked. The only call that allocates.
  InverseDynamics(const Robot& robot, const Eigen::VectorXd& Phi);

  /// H qddot + C qdot + G of the sample that the kinematics of the same robot were started with, in
  /// generalised order: base force (N) and moment about the base origin (N m) in base axes, then
  /// joint torques. Valid until the next call. Never allocates or throws.
  const Eigen::VectorXd& operator()(Kinematics& kinematics) noexcept;

 private:
  struct Body {
    int link;
    double m;
    Eigen::Vector3d h;      ///< first moment, link axes, kg m
    Eigen::Matrix3d Sigma;  ///< second moments, integral of r r^T dm, kg m^2
  };
  struct Wrench {
    Eigen::Vector3d f, n;  ///< on the link, its axes, about its origin
  };

  std::vector<Body> bodies_;      ///< links with parameters and all that carry them, parents first
  std::vector<Wrench> wrenches_;  ///< one for each link of the robot
  Eigen::VectorXd force_;
};

}  // namespace shapeid::fast
