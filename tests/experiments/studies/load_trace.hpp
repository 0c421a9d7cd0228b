// A division run on a load's window, watched from outside.
#pragma once

#include <vector>

#include "shapeid/models/division.hpp"
#include "shapeid/tests/experiments/data/load_data.hpp"

namespace shapeid::experiments {

struct LoadTrace {
  std::vector<LoadError> errors;  ///< after 0, 1, 2, ... divisions
  std::vector<double> f;          ///< data term, likewise
  std::vector<double> smallest;   ///< share of the area that the part just divided has
  int published_stop = 0;         ///< divisions at which the step rule with its patience stops
  double floor = 0.0;             ///< of infinitely many divisions
};

/// Divides `most` times, or as often as the criterion finds something to divide; then the last
/// entries repeat. `lambda_share`: lambda over || F ||^2 V0 / M0^2 (the default is 1e-12).
[[nodiscard]] LoadTrace trace_load(const BodyModel& area, const DataTerm& f,
                                   const InertialParameters& truth, const DivisionOptions& options,
                                   int most, double lambda_share = 1e-12);

/// M0 = 1 kg, k1, k2, eps and patience by default.
[[nodiscard]] DivisionOptions default_division();

}  // namespace shapeid::experiments
