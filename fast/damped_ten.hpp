// Damped least squares of ten unknowns on ten rows.
#pragma once

#include <Eigen/Core>

#include "shapeid/fast/ten_by_ten.hpp"
#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {

/// Minimises  || R E^T y - c ||^2 + lambda || y ||^2  for one link: what ColumnQr does for several,
/// at a size where rows fit registers. An unknown whose row of E is zero is zero. Nothing allocates
/// or throws.
class DampedTen {
 public:
  /// [R c]: the triangle of one link. E has `rank` rows, and zeros below them. lambda > 0.
  void factorise(const Eigen::MatrixXd& R, const TenRows& E, int rank, double lambda) noexcept;
  /// The first ten entries of y.
  void solve(Eigen::VectorXd& y) const noexcept;
  /// Replaces x, ten entries, by the solution z of  (E R^T R E^T + lambda) z = x.
  void solve_normal(Eigen::VectorXd& x) const noexcept;

 private:
  // Of the triangle T:
  TenRows rows_;     ///< right of its diagonal, each over its own diagonal entry
  TenRows columns_;  ///< above its diagonal, likewise
  Dozen inverse_;    ///< 1 over its diagonal
  Dozen right_;      ///< the right-hand side
};

}  // namespace shapeid::fast
