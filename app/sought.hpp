// Which links are sought, of which shapes they are made, and how heavy they roughly are.
#pragma once

#include <string>
#include <vector>

#include "shapeid/app/inputs.hpp"
#include "shapeid/models/body_model.hpp"

namespace shapeid::app {

struct SoughtLinks {
  std::string shapes;
  std::vector<std::string> free_links;
  bool whole_body = false;
  double expected_mass = 0.0;  ///< kg; 0: as robot.yaml or the URDF say

  void add_to(CLI::App& verb);
};

/// From shapes.yaml, else from the collision bodies of the links that are named (the base of a
/// floating robot by default). Throws InputError.
[[nodiscard]] BodyModel sought_bodies(const SoughtLinks& sought, const RobotInputs& robot);

/// M0: said on the command line, else the expected range in robot.yaml, else the given masses.
/// Throws InputError if none says anything.
[[nodiscard]] double expected_mass(const SoughtLinks& sought, const RobotInputs& robot,
                                   const BodyModel& model);

/// What robot.yaml expects of links that are not sought does not count, and is a warning of the
/// robot's from here on.
void warn_of_unused_masses(const std::vector<int>& sought, RobotInputs& robot);
/// The same in words; empty where all of it counts.
[[nodiscard]] std::string unused_masses(const std::vector<int>& sought, const RobotInputs& robot);

}  // namespace shapeid::app
