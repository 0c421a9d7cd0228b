// Claim C3. The mass problem (15), solved by a primal active-set method whose every step is one KKT
// system, factored anew. Slow and plain on purpose.
#pragma once

#include <Eigen/Core>

#include "shapeid/models/mass_problem.hpp"

namespace shapeid::reference {

/// Minimiser of the problem, started from `start` (kg, any m >= 0; zeros for a cold start). The
/// shapes with mass at the start are free in the first KKT system. For lambda > 0 the answer does
/// not depend on the start; for lambda = 0 it is one of the minimisers. Masses are exactly zero or
/// positive. Throws Refusal "not-finite" if numbers of the problem are not finite, or so large that
/// they are not as soon as they are computed with; Defect if the iteration bound, stated in the
/// source with its reason, is exceeded.
[[nodiscard]] MassSolution solve_masses(const MassProblem& problem, const Eigen::VectorXd& start);
[[nodiscard]] MassSolution solve_masses(const MassProblem& problem);

/// Empty if the start has one finite mass >= 0 for every shape.
[[nodiscard]] Violation why_no_start(const MassProblem& problem, const Eigen::VectorXd& start);

/// How far m is from satisfying the KKT conditions, each scaled by its own terms and free of units:
/// zero for the exact optimum, a modest multiple of the machine epsilon for a good answer.
struct KktResidual {
  double primal = 0.0;           ///< most negative mass over the largest mass
  double dual = 0.0;             ///< most negative gradient entry over its terms' size
  double complementarity = 0.0;  ///< largest gradient entry at a positive mass, likewise
  [[nodiscard]] double worst() const;
};

[[nodiscard]] KktResidual kkt_residual(const MassProblem& problem, const Eigen::VectorXd& m);

}  // namespace shapeid::reference
