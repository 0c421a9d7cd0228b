// The robots of the blind tests: as they are, and as their files say.
#pragma once

#include <string>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/simbody/trot_controller.hpp"

namespace shapeid::blind {

struct Machine {
  std::string name;        ///< "arm", "quadruped", or "drawn", "trotter" and a seed
  std::string urdf, yaml;  ///< the texts
  Robot robot;             ///< as it is: the texts' numbers
  RobotNotes notes;
  std::vector<int> free_links;  ///< the diagnosis is told wrong inertias of these
  double rate = 0.0;            ///< Hz, of logs
  double cutoff = 0.0;          ///< Hz, of the filter that the diagnosis is told to use
  double frequency = 0.2;       ///< Hz, of an arm's slowest swing
  TrotOptions trot;             ///< of a quadruped
};

inline const std::string drawn_prefix = "drawn", quadruped_prefix = "trotter";

[[nodiscard]] Machine arm();
[[nodiscard]] Machine quadruped();
/// Any of them by its name; throws InputError where there is none.
[[nodiscard]] Machine machine(const std::string& name);

/// Inertias near the true ones, each of a body that can exist: what the diagnosis is given.
[[nodiscard]] std::vector<InertialParameters> wrong_inertias(const Machine& machine,
                                                             std::uint64_t seed);

/// The robot with these inertias of its free links.
[[nodiscard]] Robot with_inertias(const Machine& machine,
                                  const std::vector<InertialParameters>& inertias);

}  // namespace shapeid::blind
