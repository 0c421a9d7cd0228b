// The bundled quadruped, for the tests of this folder.
#pragma once

#include <string>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/urdf.hpp"

namespace shapeid::test {

inline const std::string robots = SHAPEID_SOURCE_DIR "/models/robots/";

/// quadruped.urdf with the contacts of quadruped.robot.yaml.
inline Robot quadruped() {
  Robot robot = read_urdf(robots + "quadruped.urdf").robot;
  static_cast<void>(read_robot_yaml(robots + "quadruped.robot.yaml", robot));
  return robot;
}

}  // namespace shapeid::test
