// Claim C3. The mass problem (15) in one call, for those who do not need the pace of MassSolver.
#pragma once

#include <Eigen/Core>

#include <optional>

#include "shapeid/models/mass_problem.hpp"

namespace shapeid::fast {

/// `reference::solve_masses` by a MassSolver made for this problem, which has ten rows of U a link
/// and whose shapes belong to one link each. Empty if it declines. Allocates.
[[nodiscard]] std::optional<MassSolution> solve_masses(const MassProblem& problem,
                                                       const Eigen::VectorXd& start);
[[nodiscard]] std::optional<MassSolution> solve_masses(const MassProblem& problem);

/// Empty if U has ten rows a link, and no column with entries of two links.
[[nodiscard]] Violation why_not_by_links(const MassProblem& problem);

}  // namespace shapeid::fast
