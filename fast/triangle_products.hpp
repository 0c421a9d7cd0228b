// Products with the triangle R of a window, ten columns a link.
#pragma once

#include <Eigen/Core>

#include "shapeid/fast/ten_by_ten.hpp"

namespace shapeid::fast {

/// Rows of R's right-hand side that parameters can reach.
[[nodiscard]] inline auto right_hand_side(const Eigen::MatrixXd& R) noexcept {
  return R.col(R.cols() - 1).head(R.cols() - 1);
}

/// a += R e, where e is `u`, ten numbers, in the entries of `link` and zero elsewhere. Only the
/// first 10 (link + 1) entries of a change.
void add_column(const Eigen::MatrixXd& R, int link, const double* u, double* a) noexcept;

/// R e_k, where e_k is the k-th row of E, ten numbers, in the entries of `link` and zero elsewhere,
/// for the first `rank` rows of E: ten numbers a link up to this one, `apart` numbers from those of
/// one link to those of the next. They are written from `a` on, a column every `stride` numbers.
void link_columns(const Eigen::MatrixXd& R, int link, const TenRows& E, int rank,
                  Eigen::Index apart, double* a, Eigen::Index stride) noexcept;

/// g = R^T r: 10 per link.
void slopes_of(const Eigen::MatrixXd& R, const Eigen::VectorXd& r, Eigen::VectorXd& g) noexcept;

/// Sums of the absolute values in each column of R: upper bounds of the columns' lengths, without
/// square roots. Not finite if a number in R's columns is not.
void column_sizes(const Eigen::MatrixXd& R, Eigen::VectorXd& lengths) noexcept;

}  // namespace shapeid::fast
