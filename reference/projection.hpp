// Claim C2. Equations (7)-(9): rows of the dynamics that no contact force can reach.
#pragma once

#include <Eigen/Core>

#include "shapeid/models/contract.hpp"

namespace shapeid::reference {

/// Empty if the diagonal of W has one positive finite entry for each of `rows` rows.
[[nodiscard]] Violation why_no_weight(const Eigen::VectorXd& weight, Eigen::Index rows);

/// Orthonormal basis of what is left of the (weighted) rows after contact forces are eliminated.
/// Q2 is only defined up to a rotation: compare Q2 Q2^T, or what is computed from it.
struct ContactFreeBasis {
  Eigen::MatrixXd Q2;  ///< rows x (rows - rank): null space of J W^(1/2)
  int rank = 0;  ///< numerical rank of W^(1/2) J^T, less than J's rows if forces are redundant
};

/// Equations (7)-(8): Q2 from the rank-revealing QR of W^(1/2) J^T = [Q1 Q2] [R; 0] P^T. `weight`
/// holds the diagonal of W. The identity if J has no rows.
[[nodiscard]] ContactFreeBasis contact_free_basis(const Eigen::MatrixXd& J,
                                                  const Eigen::VectorXd& weight);

/// Rows of one sample with contact forces eliminated: minimising || Y Phi - F || over Phi is
/// minimising || W^(1/2) (Y_full Phi - F_full - J^T f) || over Phi and f (equation (9) for W = I).
struct ContactFreeRows {
  Eigen::MatrixXd Y;  ///< Q2^T W^(1/2) Y_full
  Eigen::VectorXd F;  ///< Q2^T W^(1/2) F_full
  int rank = 0;       ///< of W^(1/2) J^T: how many rows the forces took
};

/// `Y` (Y_full): rows x columns. `F` (F_full), rows: S^T tau, less what known links take
/// (SampleRows). `J`: contact rows x rows. `weight`: the diagonal of W.
[[nodiscard]] ContactFreeRows eliminate_contacts(const Eigen::MatrixXd& Y, const Eigen::VectorXd& F,
                                                 const Eigen::MatrixXd& J,
                                                 const Eigen::VectorXd& weight);

}  // namespace shapeid::reference
