// The bundled quadruped as a user has it: URDF, robot.yaml and shapes.yaml; and how it trots.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/simbody/simulation.hpp"

namespace shapeid::test {

struct Quadruped {
  Robot robot;  ///< with its contacts
  RobotNotes notes;
  BodyModel base;  ///< the base as eleven shapes, the legs known; the truth lies in their cone
};
[[nodiscard]] Quadruped bundled_quadruped();

struct Trot {
  double seconds = 2.0;
  double rate = 100.0;  ///< Hz
  std::uint64_t seed = 1;
  std::optional<Load> load;
};
/// Exact samples of a trot that does not fall.
[[nodiscard]] std::vector<SimulatedSample> trot(const Robot& robot, const Trot& wanted);

/// Every given link as `parts` cuboids (a power of two) that together are the uniform cuboid of its
/// true inertia, in equal volumes: the truth is in the cone of the shapes, and not on its edge.
[[nodiscard]] BodyModel divided_cuboids(const Robot& robot, const std::vector<int>& links,
                                        int parts);

}  // namespace shapeid::test
