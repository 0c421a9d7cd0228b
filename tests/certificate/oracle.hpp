// The oracle of the oracle: every active set of a small problem in rational arithmetic. It shares
// no code with the certificate, only GMP's numbers.
#pragma once

#include <gmpxx.h>

#include <vector>

#include "shapeid/models/stated_problem.hpp"

namespace shapeid::test {

/// f at a point in doubles, exactly.
[[nodiscard]] mpq_class exact_objective(const StatedProblem& problem, const Eigen::VectorXd& m,
                                        const Eigen::VectorXd& x);

struct ExactMinimum {
  mpq_class value;
  std::vector<mpq_class> m, x;
};

/// The minimum over m >= 0, the bounds of x and the declared mass, if there is one, by trying each
/// unknown free and at each of its bounds, and the sum of the masses free and at its own. For up to
/// about eight unknowns.
[[nodiscard]] ExactMinimum minimum_of_all_active_sets(const StatedProblem& problem);

}  // namespace shapeid::test
