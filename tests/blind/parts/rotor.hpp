// A rotor that spins with its joint and rides on the link before: what it asks of all drives.
#pragma once

#include <Eigen/Core>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::blind {

/// N m, n: Lagrange's equations of the kinetic energy dq_j z_j . omega of the parent,
/// differentiated numerically, per kg m^2 of gear times rotor inertia. For a robot on a fixed base.
[[nodiscard]] Eigen::VectorXd rotor_torque(const Robot& robot, const Sample& sample, int joint);

}  // namespace shapeid::blind
