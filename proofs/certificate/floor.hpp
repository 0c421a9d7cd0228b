// How low infinitely many divisions could bring the objective: a floor under all of them.
#pragma once

#include <optional>
#include <vector>

#include "shapeid/models/stated_problem.hpp"
#include "shapeid/proofs/certificate/rational.hpp"

namespace shapeid::certificate {

/// Where the polynomial of a link is lowest: a place for a point mass that lowers the objective.
struct Place {
  Eigen::Index link = 0;
  Eigen::Vector3d point;  ///< m, link frame
};

struct Floor {
  Rational value;           ///< no mass distribution in the regions has a lower data term
  std::vector<Place> next;  ///< at most one a link; empty if mass nowhere would lower it
};

/// From the residual of any parameters (10 free links) and other unknowns: the nearer they are to
/// the limit, the higher the floor. For any nonnegative masses in the regions that add up to no
/// more than the declared mass bound. Empty if the problem has no regions on some free link, or no
/// declared bound where one is needed.
[[nodiscard]] std::optional<Floor> floor_of_divisions(const StatedProblem& problem,
                                                      const Eigen::VectorXd& Phi,
                                                      const Eigen::VectorXd& x);

}  // namespace shapeid::certificate
