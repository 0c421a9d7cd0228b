// Claim C1. Y Phi without Y: what given inertial parameters take.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/reference/kinematics.hpp"

namespace shapeid::reference {

/// Equations (2)-(3): H qddot + C qdot + G = Y Phi, in generalised order: base force (N) and moment
/// about the base origin (N m) in base axes, then joint torques. `motions`: of all links
/// (link_motions()). `Phi`: 10 per link, stacked.
[[nodiscard]] Eigen::VectorXd inverse_dynamics(const Robot& robot,
                                               const std::vector<LinkMotion>& motions,
                                               const Eigen::VectorXd& Phi);

}  // namespace shapeid::reference
