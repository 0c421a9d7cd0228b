// One division run by either path, and where they part.
#pragma once

#include <optional>
#include <string>

#include "shapeid/tests/support/any_model.hpp"

namespace shapeid::test {

/// How a fast run compares with a reference run of the same problem.
struct RunComparison {
  int divisions = 0;  ///< that both did, of the same shapes
  bool declined = false;
  /// Where they first divide different shapes: the largest difference of the two shapes' v, over
  /// the larger v, in either run. Empty if they never do.
  std::optional<double> tie_at_difference;
  /// Largest over all equal divisions, in units of the problem's own rounding.
  double worst_objective = 0.0;
  /// After the last equal division, over the largest mass; active sets are compared where no mass
  /// is that small.
  double worst_mass = 0.0;
  double worst_Phi = 0.0;        ///< over the terms of each entry
  std::string first_difference;  ///< in words, with the input; empty if there is none
};

/// Runs both with up to `most_divisions` divisions and no stopping rule.
[[nodiscard]] RunComparison compare_runs(const ModelWithRows& given, int most_divisions);

}  // namespace shapeid::test
