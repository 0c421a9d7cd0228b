// The limit of infinitely many divisions: parameters near it, from which a floor is proved.
#pragma once

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/stated_problem.hpp"
#include "shapeid/proofs/certificate/relaxations.hpp"

namespace shapeid::app {

struct LimitOptions {
  int most_rounds = 60;
  /// Stop when the floor is this near to what the point masses reach, relative to it.
  double gap = 1e-6;
};

/// Adds a point mass in each region where its polynomial is lowest, solves without the density
/// term, drops the masses that became zero, and repeats (docs/derivations/certificate.md). Starts
/// from the problem's own shapes. Empty for a problem without regions or other than masses.
[[nodiscard]] certificate::Guess limit_of_divisions(const StatedProblem& stated,
                                                    const LimitOptions& options = {});

/// Proved: no data term of the problem is below, however finely the model is divided. Zero where
/// nothing higher is.
[[nodiscard]] double floor_of_divisions(const BodyModel& undivided, const MassProblem& problem);

}  // namespace shapeid::app
