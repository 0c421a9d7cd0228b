// The six methods on the same windows.
#pragma once

#include <string>
#include <vector>

#include "shapeid/tests/experiments/data/windows.hpp"
#include "shapeid/tests/experiments/methods/method.hpp"
#include "shapeid/tests/recovery/quadruped.hpp"

namespace shapeid::experiments {

struct Contestant {
  std::string key;    ///< in names of numbers
  std::string words;  ///< on the page
  std::unique_ptr<Method> method;
};

/// The bundled quadruped's base: eleven shapes, 54 points, and a guess of size and mass.
[[nodiscard]] Setting base_setting(const test::Quadruped& quadruped);

/// Linear, Nonlinear, Full, Points, Ours, and Ours divided until within a hundredth of the floor.
[[nodiscard]] std::vector<Contestant> contestants(const Setting& setting);

/// What a method says of consecutive windows.
struct Course {
  std::vector<Answer> answers;     ///< one a window, before filter (17)
  std::vector<Vector10> filtered;  ///< after it, alpha = 0.5
};

[[nodiscard]] Course run(Method& method, const std::vector<TimedWindow>& windows);

}  // namespace shapeid::experiments
