// A simulated robot's sensors, written as a log.
#pragma once

#include <string>

#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/simbody/sensors.hpp"
#include "shapeid/models/simbody/simulation.hpp"

namespace shapeid::app {

/// Simulates the quadruped and writes what it measures to `path`. Throws Refusal "fell" if it
/// falls.
SimulationReport record(const Robot& robot, const RobotNotes& notes,
                        const SimulationOptions& simulation, const SensorOptions& sensors,
                        const std::string& path);

}  // namespace shapeid::app
