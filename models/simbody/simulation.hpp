// A quadruped that trots in Simbody, and what it measures. No Simbody header is included here.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/models/simbody/disturbance.hpp"
#include "shapeid/models/simbody/ground.hpp"
#include "shapeid/models/simbody/load.hpp"
#include "shapeid/models/simbody/robot_state.hpp"
#include "shapeid/models/simbody/trot_controller.hpp"

namespace shapeid {

struct SimulationOptions {
  double duration = 10.0;  ///< s
  double rate = 500.0;     ///< Hz, of the samples
  std::uint64_t seed = 1;  ///< of the phases and frequencies of the wanted motion
  TrotOptions trot;
  Ground ground;
  std::optional<Load> load;  ///< the controller does not know
  double load_from = 0.0;    ///< s: the load is put on at this moment, moving along already
  /// s: and taken off at this one.
  double load_until = std::numeric_limits<double>::infinity();
  Disturbance disturbance;  ///< acts besides all that; its work is not counted
  double accuracy = 1e-5;   ///< of the integrator, relative
};

/// One instant of the simulated truth. All of it belongs to the same instant, so the equation of
/// motion holds between accelerations, torques and contact forces up to rounding.
struct SimulatedSample {
  Sample sample;  ///< with exact accelerations and contact forces
  RobotState state;
  double drive_work = 0.0;   ///< J since the start, by the joints
  double ground_work = 0.0;  ///< J since the start, by the ground on the contact points
};

struct SimulationReport {
  std::size_t samples = 0;
  double distance = 0.0;          ///< m, from start to end, in the plane
  std::optional<double> fell_at;  ///< s: base too low or tilted too far; the simulation ends there
};

/// Lets the robot trot and hands every sample over, in the order of time, from time 0 on. The same
/// robot and options give the same samples, bit for bit. Throws InputError if the robot cannot trot
/// (see TrotController) or an option makes no sense.
SimulationReport simulate(const Robot& robot, const SimulationOptions& options,
                          const std::function<void(const SimulatedSample&)>& on_sample);

}  // namespace shapeid
