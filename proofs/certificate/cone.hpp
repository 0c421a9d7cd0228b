// Whether parameters can be made of the shapes: masses that do it, or a plane that separates.
#pragma once

#include "shapeid/models/mass_problem.hpp"
#include "shapeid/proofs/certificate/rational.hpp"

namespace shapeid::certificate {

/// The point U m, m >= 0, nearest to Phi, each row measured in the power of two next to its largest
/// unit parameter. If the distance is not zero then `plane` proves that no masses make Phi:
/// plane^T u_j >= 0 for every shape and plane^T Phi < 0.
struct NearestBody {
  Vector m;
  Rational square_distance;  ///< zero: U m = Phi exactly
  Vector plane;              ///< 10 per free link; zeros if U m = Phi
};

/// By the method of Lawson and Hanson in exact arithmetic, which ends.
[[nodiscard]] NearestBody nearest_body(const MassProblem& problem, const Eigen::VectorXd& Phi);

/// Checks such a proof from its definition.
[[nodiscard]] bool separates(const Vector& plane, const MassProblem& problem,
                             const Eigen::VectorXd& Phi);

}  // namespace shapeid::certificate
