// Damped least squares of ten unknowns on ten rows.
#pragma once

#include <Eigen/Core>

#include <array>

#include "shapeid/fast/link_density.hpp"
#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {

/// Minimises  || R E^T y - c ||^2 + lambda || y ||^2  for one link: what ColumnQr does for several,
/// at a size where rows fit registers. An unknown whose row of E is zero is zero. Nothing allocates
/// or throws.
class DampedTen {
 public:
  /// [R c]: the triangle of one link. lambda > 0.
  void factorise(const Eigen::MatrixXd& R, const LinkDensity::Rows& E, double lambda) noexcept;
  /// The first ten entries of y.
  void solve(Eigen::VectorXd& y) const noexcept;
  /// Replaces x, ten entries, by the solution z of  (E R^T R E^T + lambda) z = x.
  void solve_normal(Eigen::VectorXd& x) const noexcept;

 private:
  void back_substitute(Eigen::VectorXd& x) const noexcept;

  std::array<Dozen, 10> T_;           ///< right of the diagonal; entry 10 is the right-hand side
  std::array<double, 10> inverse_{};  ///< 1 over the diagonal
};

}  // namespace shapeid::fast
