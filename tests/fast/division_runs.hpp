// One division run by either path, and where they part.
#pragma once

#include <optional>
#include <string>

#include "shapeid/tests/support/any_model.hpp"

namespace shapeid::test {

/// How a fast run compares with a reference run of the same problem. The worst over the first solve
/// and all equal divisions.
struct RunComparison {
  int divisions = 0;  ///< that both did, of the same shapes
  bool declined = false;
  /// Where they first divide different shapes: the largest difference of the two shapes' v, over
  /// the larger v, in either run. Empty if they never do.
  std::optional<double> tie_at_difference;
  /// There: how far the runs' v of one of the two shapes are apart, over the larger v of the two.
  double v_apart_at_difference = 0.0;
  double worst_objective = 0.0;    ///< in roundings of the problem's terms
  double worst_scaled_mass = 0.0;  ///< in roundings of the gradient's terms
  double worst_mass = 0.0;         ///< over the largest mass
  double worst_Phi = 0.0;          ///< over its length
  int other_side = 0;              ///< most shapes that have mass by one and none by the other
  double reference_seconds = 0.0, fast_seconds = 0.0;
  std::string first_difference;  ///< in words, with the input; empty if there is none
};

/// Runs both with up to `most_divisions` divisions and no stopping rule.
[[nodiscard]] RunComparison compare_runs(const ModelWithRows& given, int most_divisions);

}  // namespace shapeid::test
