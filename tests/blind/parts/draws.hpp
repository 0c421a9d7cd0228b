// What robots that nobody chose are drawn with.
#pragma once

#include <Eigen/Core>

#include <cstddef>

#include "shapeid/models/simbody/random.hpp"

namespace shapeid::blind {

inline constexpr double pi = 3.141592653589793;
inline constexpr double gravity = 9.81;  // m/s^2

/// One of the first `count` numbers, from 0.
[[nodiscard]] inline std::size_t draw(Random& random, std::size_t count) {
  return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
}

[[nodiscard]] inline bool chance(Random& random, double share) { return random.uniform() < share; }

/// Any, of length one.
[[nodiscard]] inline Eigen::Vector3d direction(Random& random) {
  Eigen::Vector3d d;
  for (double& x : d) x = random.normal();
  return d.normalized();
}

}  // namespace shapeid::blind
