// Which links a regressor is asked for.
#pragma once

#include <rapidcheck.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "shapeid/models/robot.hpp"

namespace shapeid::test {

[[nodiscard]] inline std::vector<int> all_links(const Robot& robot) {
  std::vector<int> links(robot.links.size());
  std::iota(links.begin(), links.end(), 0);
  return links;
}

/// Any of the robot's links, none and all included, not always in its order; drawn with rapidcheck.
[[nodiscard]] inline std::vector<int> some_links(const Robot& robot) {
  std::vector<int> links;
  for (int i = 0; i < robot.link_count(); ++i) {
    if (*rc::gen::arbitrary<bool>()) links.push_back(i);
  }
  const auto count = static_cast<std::ptrdiff_t>(links.size());
  std::rotate(links.begin(), links.begin() + *rc::gen::inRange<std::ptrdiff_t>(0, count + 1),
              links.end());
  return links;
}

}  // namespace shapeid::test
