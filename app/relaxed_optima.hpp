// Optima over larger sets than the shapes make, in doubles: what the exact checker proves their
// values from.
#pragma once

#include <vector>

#include "shapeid/models/stated_problem.hpp"
#include "shapeid/proofs/certificate/relaxations.hpp"

namespace shapeid::app {

/// The least data term with nothing asked but masses >= 0. Empty for a problem with other columns.
[[nodiscard]] certificate::Guess least_over_masses(const StatedProblem& stated);

/// Points on the way to the least data term over all bodies that can exist, by a barrier: each
/// strictly inside, the last the nearest. Empty for a problem with other columns.
[[nodiscard]] std::vector<certificate::Guess> path_to_least_over_bodies(
    const StatedProblem& stated);

/// The last of them whose residual proves a floor under all bodies; of none, the last.
[[nodiscard]] certificate::Guess least_over_bodies(const StatedProblem& stated);

}  // namespace shapeid::app
