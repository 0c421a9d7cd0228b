// A trot of the bundled quadruped by Simbody, with noise of torque alone, and what its logs are
// searched with.
#pragma once

#include <cstddef>
#include <vector>

#include "shapeid/diagnosis/loop.hpp"
#include "shapeid/diagnosis/recording.hpp"
#include "shapeid/models/simbody/simulation.hpp"

namespace shapeid::test {

/// The bundled quadruped, as its files have it.
[[nodiscard]] Robot quadruped();

struct Trot {
  Trot();

  /// All inertias are known.
  [[nodiscard]] diagnosis::LoopSettings settings() const;
  /// The base's is sought.
  [[nodiscard]] diagnosis::LoopSettings settings_for_base() const;

  /// A foot's flag comes so much (s) after the touch, and goes so much before the foot does.
  [[nodiscard]] diagnosis::Recording told(std::size_t foot, double late, double early) const;

  static constexpr double rate = 500.0;  // Hz
  Robot robot;
  std::vector<Sample> samples;
  std::vector<Eigen::Matrix3d> attitude;  ///< base axes in the world, one a sample
};

}  // namespace shapeid::test
