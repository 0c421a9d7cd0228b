// Optima over larger sets than any set of shapes, for one link and lambda = 0, by methods that
// share nothing with the mass solver.
#pragma once

#include "shapeid/models/inertia.hpp"
#include "shapeid/models/mass_problem.hpp"

namespace shapeid::test {

/// Least data term over all parameters with mass >= 0. Y has ten independent columns.
[[nodiscard]] double optimum_over_masses(const MassProblem& problem);

/// The least data term over all bodies that can exist lies in [lower, upper]. `upper` belongs to
/// the body; `lower` is proved by weak duality, however the body was found.
struct ConsistentOptimum {
  InertialParameters body;
  double lower = 0.0, upper = 0.0;
};

/// Levenberg-Marquardt on Sigma = L L^T. Y has ten independent columns. `length` (m) is the size of
/// the body, to bring moments of all orders to one scale.
[[nodiscard]] ConsistentOptimum optimum_over_bodies(const MassProblem& problem, double length);

}  // namespace shapeid::test
