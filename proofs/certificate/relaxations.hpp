// The optima of larger and larger sets on one data set, at lambda = 0, each between two numbers.
#pragma once

#include <optional>

#include "shapeid/models/stated_problem.hpp"
#include "shapeid/proofs/certificate/rational.hpp"

namespace shapeid::certificate {

/// A point of a problem in doubles, near some optimum: parameters (10 per free link) and the other
/// unknowns. Without parameters: none. What is proved from it does not ask who computed it.
struct Guess {
  Eigen::VectorXd parameters, others;
};

/// What relaxations are proved from.
struct Evidence {
  Guess limit;   ///< near the limit of infinitely many divisions
  Guess bodies;  ///< near the optimum over all bodies that can exist, and itself one of them
  Guess masses;  ///< near the optimum with nothing asked but masses >= 0; zero where a mass is held
};

/// The least data term lies between these.
struct Interval {
  Rational lower;
  std::optional<Rational> upper;  ///< empty: none was proved
};

/// Claim C18. Each set holds the next, so each optimum is at most the next: parameters with no
/// negative mass; bodies that can exist; mass anywhere in the regions, however finely divided; the
/// shapes. With at most the declared mass, if one is declared. The two middle ones hold the shapes'
/// columns as they are written, which rounding may have put a little outside of what shapes make.
struct Relaxations {
  Interval masses, bodies, divisions, shapes;
};

/// `shapes`: what is known of the least objective of the shapes themselves, the data term where
/// lambda = 0. A bound of one set is carried over to those that it implies.
[[nodiscard]] Relaxations relaxations(const StatedProblem& stated, const Evidence& evidence,
                                      Interval shapes);

}  // namespace shapeid::certificate
