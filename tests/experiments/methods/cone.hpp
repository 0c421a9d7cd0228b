// Sets of parameters given by a linear matrix inequality, and the least data term over them.
#pragma once

#include <vector>

#include "shapeid/tests/experiments/methods/data_term.hpp"

namespace shapeid::experiments {

/// All Phi with sum_i Phi_i A_i positive semidefinite.
struct Cone {
  std::vector<Eigen::MatrixXd> A;  ///< ten symmetric matrices
  Vector10 inside;                 ///< a Phi whose matrix is well inside, kg, kg m, kg m^2

  [[nodiscard]] Eigen::MatrixXd matrix(const Vector10& Phi) const;
};

/// Bodies that can exist: pseudo-inertia positive semidefinite (4 x 4). `length` (m) is the size of
/// the body; it brings entries to one scale and changes no set.
[[nodiscard]] Cone consistent_bodies(double length);

/// The paper's condition (6): mass and rotational inertia about the centre of mass positive
/// semidefinite, triangle inequalities left out. The same as the 6 x 6 spatial inertia being so
/// (its Schur complement): the set is convex.
[[nodiscard]] Cone positive_bodies(double length);

struct ConeOptimum {
  Vector10 Phi;
  double value = 0.0;  ///< f at Phi, which lies inside the set
  double floor = 0.0;  ///< f is nowhere on the set below this
};

/// Barrier method: minimises f - mu log det of the matrix by Newton's method, for mu that falls.
/// mu times the inverse matrix is positive definite, so that each mu gives a dual point and with it
/// a proven floor (rounding aside).
[[nodiscard]] ConeOptimum least_over(const Cone& cone, const DataTerm& f);

}  // namespace shapeid::experiments
