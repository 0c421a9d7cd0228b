// Problems whose certificates are looked at.
#pragma once

#include <rapidcheck.h>

#include "shapeid/models/problem_json.hpp"
#include "shapeid/models/stated_problem.hpp"

namespace shapeid::test {

/// Twenty samples of a trunk that carries a load of 1 kg, filled with 6 x 4 x 2 cuboids, 1 % noise,
/// with regions.
[[nodiscard]] StatedProblem load_problem();

/// Thirteen coupled links, 130 rows, `per_link` cuboids on each.
[[nodiscard]] StatedProblem body_problem(int per_link);

/// One row, one point mass t: (t - 1)^2 + t^2, and t at most 1/8. Without that bound t = 1/2 is
/// best.
[[nodiscard]] StatedProblem one_point_problem();

/// Small problems with up to three other columns: free, bounded on one side or on both.
[[nodiscard]] rc::Gen<StatedProblem> small_problem(bool zero_lambda);

/// An answer with these masses that says what is true of it, as far as doubles can.
[[nodiscard]] Answer honest_answer(const StatedProblem& problem, const Eigen::VectorXd& m,
                                   const Eigen::VectorXd& x = {});

}  // namespace shapeid::test
