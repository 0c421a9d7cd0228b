// Which parameters the data determine, and which come from the shapes and the density term.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace shapeid::reference {

/// Rows of one contiguous block of time, already weighted and free of contact forces.
struct RowBlock {
  Eigen::MatrixXd rows;  ///< [Y F], a triangle
};

/// Per parameter of the free links (10 each).
struct Determination {
  /// Standard error of plain least squares, without shapes or bounds, in the parameter's unit.
  /// Infinite where the data say nothing. Allows for autocorrelation within a block.
  Eigen::VectorXd standard_error;
  /// The error is below `largest_share` of the size that the shapes could give the parameter.
  std::vector<bool> determined;
  int rank = 0;  ///< directions of parameter space that the rows reach
};

/// A parameter whose error exceeds half of its own natural size is not known even to its sign.
inline constexpr double largest_share = 0.5;

/// Cluster-robust ("sandwich") covariance of least squares, one cluster a block:
/// (Y^T Y)^+ (sum_k g_k g_k^T) (Y^T Y)^+ with g_k = Y_k^T (Y_k Phi - F_k) (Liang, Zeger 1986).
/// `natural_size`: for each parameter the size it could have, in its unit; positive. It scales the
/// columns, so that rank and shares do not depend on units.
[[nodiscard]] Determination determine(const std::vector<RowBlock>& blocks,
                                      const Eigen::VectorXd& natural_size);

}  // namespace shapeid::reference
