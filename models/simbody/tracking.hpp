// Robots on a fixed base that follow a wanted motion as well as their drives let them.
#pragma once

#include <functional>
#include <optional>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/models/simbody/disturbance.hpp"
#include "shapeid/models/simbody/joint_trajectory.hpp"
#include "shapeid/models/simbody/load.hpp"

namespace shapeid {

struct TrackingOptions {
  JointTrajectoryOptions wanted;  ///< the rate is also the controller's
  double bandwidth = 3.0;         ///< Hz, of the position loop
  std::optional<Load> load;       ///< the controller does not know
  double load_from = 0.0;         ///< s: put on at this moment, moving along already
  Disturbance disturbance;
  double accuracy = 1e-5;  ///< of the integrator, relative
};

/// Forward dynamics: torques are those of the wanted motion plus a damped spring to it; the motion
/// is what comes of them. Every sample holds one instant's motion and torque, with no noise. Throws
/// InputError for a floating root.
void simulate_tracking(const Robot& robot, const TrackingOptions& options,
                       const std::function<void(const Sample&)>& on_sample);

}  // namespace shapeid
