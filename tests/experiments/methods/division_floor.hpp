// The limit of infinitely many divisions: a floor under every set of shapes within given regions.
#pragma once

#include <vector>

#include "shapeid/models/body_model.hpp"
#include "shapeid/tests/experiments/methods/data_term.hpp"

namespace shapeid::experiments {

struct DivisionLimit {
  Vector10 Phi;        ///< of shapes and points in the regions
  double value = 0.0;  ///< f at Phi: the limit is not above
  double floor = 0.0;  ///< the limit is not below, nor is f of any shapes in the regions
};

/// Adds a point mass where the slope of f is lowest in the regions, solves, and repeats until value
/// and floor are within `gap` of the value (or a billionth of || F ||^2). `regions`: a
/// model with one free link, of shapes that lowest_point() knows.
[[nodiscard]] DivisionLimit limit_of_divisions(const BodyModel& regions, const DataTerm& f,
                                               double gap);

/// What counts as zero beside || F ||^2: data without noise have an optimum of zero, and no gap
/// relative to it.
inline constexpr double nothing_beside_data = 1e-9;

}  // namespace shapeid::experiments
