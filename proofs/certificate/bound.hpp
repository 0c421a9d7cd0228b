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

/// sum_k of the least of 2 c_k x_k between the bounds of x_k; empty if there is none.
[[nodiscard]] std::optional<Rational> least_of_others(const ExactProblem& problem, const Vector& c);

/// A number that the objective of no feasible point with sum t <= M lies below:
///   - r^T W r - 2 F^T W r + least mass terms + sum_k min over bounds of 2 c_k x_k.
/// At the residual of an optimum it is the optimum (docs/derivations/certificate.md). Empty if
/// some term has no minimum.
[[nodiscard]] std::optional<Rational> lower_bound(const ExactProblem& problem, const Vector& r,
                                                  const std::optional<Rational>& M);

/// The x nearest in kind to the given one for which the residual of (Phi, x) has a lower bound:
/// columns that are free to move without end have no slope there. It need not keep the bounds of
/// x, and the lower bound holds all the same.
[[nodiscard]] Vector settled_columns(const ExactProblem& problem, const Vector& Phi, Vector x);

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
