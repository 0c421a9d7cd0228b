// A trot of the bundled quadruped by Simbody, with noise of torque alone, and what its logs are
// searched with.
#pragma once

#include <vector>

#include "shapeid/diagnosis/loop.hpp"
#include "shapeid/models/simbody/simulation.hpp"

namespace shapeid::test {

struct Trot {
  Trot();

  /// All inertias are known.
  [[nodiscard]] diagnosis::LoopSettings settings() const;
  /// The base's is sought.
  [[nodiscard]] diagnosis::LoopSettings settings_for_base() const;

  static constexpr double rate = 500.0;  // Hz
  Robot robot;
  std::vector<Sample> samples;
  std::vector<Eigen::Matrix3d> attitude;  ///< base axes in the world, one a sample
};

}  // namespace shapeid::test
