// Floors under all mass distributions in given regions, and under all bodies that can exist.
#pragma once

#include <optional>

#include "shapeid/models/stated_problem.hpp"
#include "shapeid/proofs/certificate/rational.hpp"

namespace shapeid::certificate {

/// Claim C15. No mass distribution in the regions has a lower data term, however finely divided;
/// nor have the shapes, with their columns as they are written (rounding may put a column outside
/// of what its shape can make). From the residual of any parameters (10 per free link) and other
/// unknowns: the nearer they are to the limit, the higher the floor. For masses that add up to no
/// more than the declared mass bound. Empty if the problem has no regions on some free link, or no
/// declared bound where one is needed.
[[nodiscard]] std::optional<Rational> floor_of_divisions(const StatedProblem& stated,
                                                         const Eigen::VectorXd& Phi,
                                                         const Eigen::VectorXd& x);

/// The same for all bodies that can exist, wherever they have mass: links with a
/// positive semidefinite pseudo-inertia. Empty also if no finite bound follows from this residual.
[[nodiscard]] std::optional<Rational> floor_of_bodies(const StatedProblem& stated,
                                                      const Eigen::VectorXd& Phi,
                                                      const Eigen::VectorXd& x);

}  // namespace shapeid::certificate
