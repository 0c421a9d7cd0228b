// Equations (7)-(9) without forming Q: reflections applied only to the columns that are needed.
#pragma once

#include <Eigen/Core>

namespace shapeid::fast {

/// What `reference::eliminate_contacts` computes, up to the rotation that Q2 leaves open: the same
/// normal equations and objective, the same rule for the rank of W^(1/2) J^T.
class ContactElimination {
 public:
  /// `weight`: diagonal of W, one entry for each row, positive, and to be within twelve decades of
  /// each other: the rank is told by pivots beside the largest W^(1/2), so that a force which only
  /// rows of far smaller weight feel would count as felt by none, and stay in them
  /// (docs/derivations/projection.md). `most_forces`: the most columns that J^T can have. The only
  /// call that allocates.
  ContactElimination(const Eigen::VectorXd& weight, Eigen::Index most_forces);

  /// `rows` = [Y F], not weighted, becomes [Q1 Q2]^T W^(1/2) [Y F]. Returns the rank: so many rows
  /// at the top are the forces', all below are free of them. `JT` holds J^T, rows x forces, finite.
  /// Never allocates (if matrices lie in memory column by column) or throws.
  Eigen::Index operator()(const Eigen::Ref<const Eigen::MatrixXd>& JT,
                          Eigen::Ref<Eigen::MatrixXd> rows) noexcept;

 private:
  Eigen::VectorXd root_;  ///< diagonal of W^(1/2)
  double largest_root_;
  Eigen::Index most_forces_;
  Eigen::MatrixXd A_;  ///< W^(1/2) J^T on its way to a triangle, and beside it the reflections
  Eigen::VectorXd inverse_half_;
};

}  // namespace shapeid::fast
