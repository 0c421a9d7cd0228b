// The force-augmented least squares problem, solved by SuiteSparse's SPQR: contact forces stay
// unknowns and nothing is projected. What equation (9) must agree with. SPQR is GPL and for tests
// only.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace shapeid::test {

/// One sample's rows: W^(1/2) (Y x - F - J^T f) with its own unknown contact forces f.
struct RowsWithForces {
  Eigen::MatrixXd Y;       ///< rows x unknowns x
  Eigen::VectorXd F;       ///< rows
  Eigen::MatrixXd J;       ///< contact rows x rows
  Eigen::VectorXd weight;  ///< rows: the diagonal of W
};

/// A minimiser over x and all f_1 .. f_N at once.
struct ForceAugmentedAnswer {
  Eigen::VectorXd x;
  std::vector<Eigen::VectorXd> f;  ///< one for each sample; not unique where J^T loses rank
  double objective = 0.0;
};

/// minimise sum_k || W_k^(1/2) (Y_k x - F_k - J_k^T f_k) ||^2. Throws std::runtime_error if SPQR
/// does not return an answer.
[[nodiscard]] ForceAugmentedAnswer solve_with_forces(const std::vector<RowsWithForces>& samples);

}  // namespace shapeid::test
