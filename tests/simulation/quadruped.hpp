// The bundled quadruped, for the tests of this folder.
#pragma once

#include <string>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/urdf.hpp"

namespace shapeid::test {

inline const std::string robots = SHAPEID_SOURCE_DIR "/models/robots/";

/// quadruped.urdf with a point contact at each foot.
inline Robot quadruped() {
  Robot robot = read_urdf(robots + "quadruped.urdf").robot;
  robot.contacts.clear();
  for (const std::string foot : {"FR_foot", "FL_foot", "RR_foot", "RL_foot"}) {
    const int link = robot.find_link(foot).value();
    for (const Member& member : robot.links[static_cast<std::size_t>(link)].members) {
      if (member.name == foot) {
        robot.contacts.push_back({foot, link, ContactKind::point, member.pose});
      }
    }
  }
  return robot;
}

}  // namespace shapeid::test
