// Mass problems built backwards from their minimiser, so that the answer is known without a solver.
#pragma once

#include <rapidcheck.h>

#include "shapeid/models/mass_problem.hpp"

namespace shapeid::test {

/// A problem, its minimiser and the gradient there: m, z >= 0 and m_j z_j = 0.
struct PlantedProblem {
  MassProblem problem;
  Eigen::VectorXd m;
  Eigen::VectorXd z;
};

struct PlantedStyle {
  int most_shapes = 12;
  bool zero_lambda = false;    ///< lambda = 0: then m is one minimiser of possibly many
  bool degenerate = false;     ///< some shapes with m_j = 0 and z_j = 0 together
  bool near_parallel = false;  ///< some columns equal to an earlier one but for 1e-2 to 1e-14
  bool badly_scaled = false;   ///< columns, volumes and weights over eight powers of ten
};

/// Zero to most_shapes shapes on one or two links, one to 25 rows. How: draw Y, W and a residual
/// rho = Y U m - F, which fix the gradient Y^T W rho with respect to Phi. Then draw m, z and
/// columns u_j, and turn each u_j along that gradient until 2 u_j^T (Y^T W rho) + 2 lambda m_j /
/// V_j = z_j. That works for any number of columns, independent or not. F follows.
[[nodiscard]] rc::Gen<PlantedProblem> planted_problem(const PlantedStyle& style);

/// |U|^T |Y|^T W (|Y| |U| m + |F|) + lambda m / V: half the gradient with every term made positive,
/// what its rounding is relative to.
[[nodiscard]] Eigen::VectorXd gradient_terms(const MassProblem& problem, const Eigen::VectorXd& m);

/// f(m) with every term made positive, likewise.
[[nodiscard]] double objective_terms(const MassProblem& problem, const Eigen::VectorXd& m);

/// Difference of two answers to a problem with lambda > 0, in roundings that the problem itself
/// allows. With D^2 = lambda / V, f is strongly convex in D m: || D (m1 - m2) || is at most
/// || D^-1 (difference of the half gradients) ||, and gradients are known to a rounding of their
/// terms.
[[nodiscard]] double scaled_mass_difference(const MassProblem& problem, const Eigen::VectorXd& m1,
                                            const Eigen::VectorXd& m2);

/// Difference of two objectives, in roundings of their terms.
[[nodiscard]] double scaled_objective_difference(const MassProblem& problem,
                                                 const Eigen::VectorXd& m1,
                                                 const Eigen::VectorXd& m2);

}  // namespace shapeid::test
