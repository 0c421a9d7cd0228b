// Products with the triangle R of a window, ten columns a link.
#pragma once

#include <Eigen/Core>

namespace shapeid::fast {

/// Rows of R's right-hand side that parameters can reach.
[[nodiscard]] inline auto right_hand_side(const Eigen::MatrixXd& R) noexcept {
  return R.col(R.cols() - 1).head(R.cols() - 1);
}

/// a += R e, where e is `u`, ten numbers, in the entries of `link` and zero elsewhere. Only the
/// first 10 (link + 1) entries of a change.
void add_column(const Eigen::MatrixXd& R, int link, const double* u, double* a) noexcept;

/// g = R^T r: 10 links.
void slopes_of(const Eigen::MatrixXd& R, const Eigen::VectorXd& r, Eigen::VectorXd& g) noexcept;

/// Sums of the absolute values in each column of R: upper bounds of the columns' lengths, without
/// square roots. Not finite if a number in R's columns is not.
void column_sizes(const Eigen::MatrixXd& R, Eigen::VectorXd& lengths) noexcept;

}  // namespace shapeid::fast
