// Singular values, compiled once: Eigen's templates for them take longer than most tests.
#pragma once

#include <Eigen/Core>

namespace shapeid::test {

/// From the largest on; of an empty matrix none.
[[nodiscard]] Eigen::VectorXd singular_values(const Eigen::MatrixXd& A);

/// A = U diag(sigma) V^T with as many columns as A's smaller side.
struct ThinSvd {
  Eigen::MatrixXd U, V;
  Eigen::VectorXd sigma;
  explicit ThinSvd(const Eigen::MatrixXd& A);
  /// The x of least length that minimises || A x - b ||, of A's numerical rank.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  /// Of the values that are more than rounding beside the largest, as Eigen counts them.
  [[nodiscard]] Eigen::Index rank() const;
};

}  // namespace shapeid::test
