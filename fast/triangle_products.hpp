// Products with the triangle R of a window, ten columns a link.
#pragma once

#include <Eigen/Core>

namespace shapeid::fast {

/// Rows of R's right-hand side that parameters can reach.
[[nodiscard]] inline auto right_hand_side(const Eigen::MatrixXd& R) noexcept {
  return R.col(R.cols() - 1).head(R.cols() - 1);
}

/// a += R e, where e is `u` in the ten entries of `link` and zero elsewhere. Only the first
/// 10 (link + 1) entries of a change.
template <typename Ten>
void add_column(const Eigen::MatrixXd& R, int link, const Ten& u, double* a) noexcept {
  using Ten1 = Eigen::Matrix<double, 10, 1>;
  for (Eigen::Index first = 0; first <= Eigen::Index{10} * link; first += 10) {
    Eigen::Map<Ten1>(a + first).noalias() +=
        R.block<10, 10>(first, Eigen::Index{10} * link).lazyProduct(u);
  }
}

/// g = R^T r: 10 links.
inline void slopes_of(const Eigen::MatrixXd& R, const Eigen::VectorXd& r,
                      Eigen::VectorXd& g) noexcept {
  for (Eigen::Index link = 0; link < g.size(); link += 10) {
    auto gl = g.segment<10>(link);
    gl.setZero();
    for (Eigen::Index first = 0; first <= link; first += 10) {
      gl += R.block<10, 10>(first, link).transpose().lazyProduct(r.segment<10>(first));
    }
  }
}

/// Sums of the absolute values in each column of R: upper bounds of the columns' lengths, without
/// square roots. Not finite if a number in R's columns is not.
inline void column_sizes(const Eigen::MatrixXd& R, Eigen::VectorXd& lengths) noexcept {
  for (Eigen::Index link = 0; link < lengths.size(); link += 10) {
    auto here = lengths.segment<10>(link);
    here.setZero();
    for (Eigen::Index first = 0; first <= link; first += 10) {
      here += R.block<10, 10>(first, link).cwiseAbs().colwise().sum().transpose();
    }
  }
}

}  // namespace shapeid::fast
