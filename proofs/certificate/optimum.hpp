// The optimum itself, where the free set is right: solved exactly, and proved by the conditions of
// Karush, Kuhn and Tucker, evaluated from their definition.
#pragma once

#include <optional>
#include <vector>

#include "shapeid/models/stated_problem.hpp"
#include "shapeid/proofs/certificate/dyadic.hpp"

namespace shapeid::certificate {

/// A point of a stated problem in doubles: masses (kg) and other unknowns.
struct Start {
  Eigen::VectorXd m, x;
};

/// An exact minimiser. All fractions have one denominator.
struct Optimum {
  Fractions m;        ///< shapes
  Fractions x;        ///< other columns
  Fractions Phi;      ///< U m
  Rational value;     ///< the optimum
  bool same = false;  ///< the start's own free set was the right one
};

/// Tries the start's free set (shapes with mass; columns strictly between their bounds) and, for
/// lambda > 0, a few that the exact slopes then suggest. Empty if none is right, or if the minimum
/// over m >= 0 breaks a declared mass bound. With lambda = 0 dependent shapes keep the start's
/// mass.
[[nodiscard]] std::optional<Optimum> prove_optimum(const StatedProblem& stated, const Start& start);

}  // namespace shapeid::certificate
