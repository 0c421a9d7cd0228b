// What payload and payload_from share: the ten parameters of a load, about the link's origin.
#pragma once

#include <vector>

#include "shapeid/diagnosis/effect.hpp"

namespace shapeid::diagnosis {

inline std::vector<Parameter> load_parameters() {
  std::vector<Parameter> list = {{"m", "kg", true, 1.0}};
  for (const char* name : {"mrx", "mry", "mrz"}) list.push_back({name, "kg m", false, 0.1});
  for (const char* name : {"Ixx", "Ixy", "Ixz", "Iyy", "Iyz", "Izz"}) {
    list.push_back({name, "kg m^2", false, 0.02});
  }
  return list;
}

/// A fixed root never moves, whatever it carries.
inline bool moves(const Robot& robot, int link) { return link > 0 || robot.root == Root::floating; }

}  // namespace shapeid::diagnosis
