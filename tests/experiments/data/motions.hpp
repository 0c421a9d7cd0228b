// Motions of the bundled quadruped, as they are and as its sensors and a filter show them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "shapeid/models/simbody/simulation.hpp"
#include "shapeid/tests/recovery/quadruped.hpp"

namespace shapeid::experiments {

struct Gait {
  std::string name;   ///< in names of numbers
  std::string words;  ///< on the page
  TrotOptions trot;
};

/// The trot of docs/simulator.md first.
[[nodiscard]] std::vector<Gait> gaits();

struct Wanted {
  Gait gait;
  double seconds = 5.0;  ///< used, after a second for standing up and the first steps
  std::uint64_t seed = 1;
  std::optional<Load> load;
};

/// Samples at 500 Hz, a little more than wanted on both sides, for the filter to lose. Throws
/// std::runtime_error if the robot falls.
[[nodiscard]] std::vector<SimulatedSample> simulated(const Robot& robot, const Wanted& wanted);

/// The wanted part, with exact accelerations.
[[nodiscard]] std::vector<Sample> exact(const std::vector<SimulatedSample>& motion, double seconds);

/// The wanted part as a robot's log gives it: the sensors' noise (sigmas of quadruped.robot.yaml
/// times `noise`), a log file, one zero-phase filter over every channel at `cutoff` (Hz),
/// differentiated.
struct Sensing {
  double noise = 1.0;
  double cutoff = 20.0;
  std::uint64_t seed = 1;
};
[[nodiscard]] std::vector<Sample> measured(const test::Quadruped& quadruped,
                                           const std::vector<SimulatedSample>& motion,
                                           double seconds, const Sensing& sensing);

}  // namespace shapeid::experiments
