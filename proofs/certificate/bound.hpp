// Weak duality: a number below the optimum, from any residual whatever.
#pragma once

#include <optional>

#include "shapeid/proofs/certificate/exact_problem.hpp"

namespace shapeid::certificate {

/// min over { t >= 0, sum t <= M } of sum_j 2 a_j t_j + lambda t_j^2 / V_j, taken jointly; M empty:
/// no bound on the sum. Empty if there is no minimum.
[[nodiscard]] std::optional<Rational> least_mass_terms(const Vector& a, const Vector& V,
                                                       const Rational& lambda,
                                                       const std::optional<Rational>& M);

/// A number that the objective of no feasible point with sum t <= M lies below:
///   - r^T W r - 2 F^T W r + least mass terms + sum_k min over bounds of 2 c_k x_k.
/// At the residual of an optimum it is the optimum (docs/derivations/certificate.md). Empty if
/// some term has no minimum.
[[nodiscard]] std::optional<Rational> lower_bound(const ExactProblem& problem, const Vector& r,
                                                  const std::optional<Rational>& M);

/// Where the mass bound M of a proof comes from: never from the answer.
struct MassBound {
  std::optional<Rational> M;
  bool declared = false;  ///< by the problem; else proved here, or unknown
};

/// The declared bound, or one that holds for every point whose objective is at most `upper`: if
/// some combination d of the rows weighs every shape by at least a positive share of its mass, then
/// the residual bounds the mass.
[[nodiscard]] MassBound mass_bound(const StatedProblem& stated, const ExactProblem& problem,
                                   const Rational& upper);

}  // namespace shapeid::certificate
