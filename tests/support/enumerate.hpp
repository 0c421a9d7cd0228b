// The oracle of the mass solver: every active set of a small problem, each by a plain least squares
// that shares no code with it.
#pragma once

#include <Eigen/Core>

#include "shapeid/models/mass_problem.hpp"

namespace shapeid::test {

/// The best masses found over all 2^n active sets (n at most about 14). Each set's unconstrained
/// minimiser is clipped at zero before it is judged, so every candidate is feasible and f of the
/// best is never below the optimum; the optimum's own set reaches it.
[[nodiscard]] Eigen::VectorXd best_of_all_active_sets(const MassProblem& problem);

}  // namespace shapeid::test
