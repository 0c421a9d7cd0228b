// Robots on a fixed base that follow a prescribed motion exactly: logs for any URDF.
#pragma once

#include <cstdint>
#include <functional>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid {

struct JointTrajectoryOptions {
  double duration = 10.0;   ///< s
  double rate = 500.0;      ///< Hz
  double frequency = 0.15;  ///< Hz, of the first harmonic
  int harmonics = 5;
  double reach = 0.7;  ///< share of the joints' range and velocity that may be used, (0, 1]
  std::uint64_t seed = 1;
};

/// Each joint follows a sum of harmonics of random amplitude and phase within its limits (a joint
/// without limits within a radian, or 0.2 m, of zero); torques are Simbody's inverse dynamics. All
/// of a sample is exact, none of it is integrated. Throws InputError for a floating root or options
/// that make no sense.
void simulate_joint_trajectory(const Robot& robot, const JointTrajectoryOptions& options,
                               const std::function<void(const Sample&)>& on_sample);

}  // namespace shapeid
