// The quadratic program that every path, test and certificate speaks about.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/models/alignment.hpp"
#include "shapeid/models/contract.hpp"

namespace shapeid {

/// minimise over m >= 0:   f(m) = || W^(1/2) (Y U m - F) ||^2 + lambda sum_j m_j^2 / V_j
///
/// Equation (15) with the split-invariant density term: the second sum is lambda times the
/// integral of density squared. Y and U are kept apart because Y U rounded to double loses its
/// exact rank of ten a link. W is the weight itself, never its square root.
struct MassProblem {
  Eigen::MatrixXd Y;    ///< rows x (10 per free link)
  Eigen::VectorXd F;    ///< rows: what the free links must explain (known links moved over)
  Eigen::VectorXd W;    ///< rows: positive weights
  Eigen::MatrixXd U;    ///< (10 per free link) x shapes: unit parameters, one column a shape
  Eigen::VectorXd V;    ///< shapes: volumes, m^3
  double lambda = 0.0;  ///< >= 0
  /// kg: a declared bound on the sum of m, used by certificates only; 0: none is declared.
  double mass_bound = 0.0;

  [[nodiscard]] Eigen::Index shapes() const { return U.cols(); }
};

/// Empty if sizes agree, all numbers but mass_bound are finite, and W, V and lambda have the right
/// sign. The mass bound is checked with the StatedProblem.
[[nodiscard]] Violation why_malformed(const MassProblem& problem);

/// f(m), with the data term and the density term apart.
struct Objective {
  double data = 0.0;
  double density = 0.0;
  [[nodiscard]] double total() const { return data + density; }
};

[[nodiscard]] Objective objective(const MassProblem& problem, const Eigen::VectorXd& m);

/// grad f(m), one entry a shape.
[[nodiscard]] Eigen::VectorXd gradient(const MassProblem& problem, const Eigen::VectorXd& m);

struct MassSolution {
  Eigen::VectorXd m;         ///< kg, >= 0
  Eigen::VectorXd Phi;       ///< U m, 10 per free link
  Objective value;           ///< f at m
  std::vector<bool> active;  ///< which bounds m_j = 0 hold with equality by the solver's choice
  int iterations = 0;
};

/// Design default for lambda: 1e-12 ||b||^2 V0 / M0^2 with b = W^(1/2) F, V0 the volume of all free
/// shapes and M0 > 0 the mass they are expected to hold (kg). Small enough not to blur a
/// concentrated load, large enough to make m unique in double arithmetic.
[[nodiscard]] double default_lambda(const MassProblem& problem, double expected_mass);

}  // namespace shapeid
