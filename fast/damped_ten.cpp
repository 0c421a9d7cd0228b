#include "shapeid/fast/damped_ten.hpp"

#include <cmath>
#include <cstddef>

namespace shapeid::fast {
namespace {

using TenRows = std::array<Dozen, 10>;

/// Householder's QR of [lambda^(1/2) I 0; R E^T c]. Reflection k joins row k of the identity, which
/// has nothing but its diagonal entry until then, with all rows below it.
SHAPEID_WIDE void triangularise(const double* R, std::size_t stride, const TenRows& E,
                                double lambda, TenRows& T,
                                std::array<double, 10>& inverse) noexcept {
  TenRows columns;  // of E: an entry an unknown
  for (std::size_t l = 0; l < 10; ++l) {
    columns[l].part[0] = Four{E[0][l], E[1][l], E[2][l], E[3][l]};
    columns[l].part[1] = Four{E[4][l], E[5][l], E[6][l], E[7][l]};
    columns[l].part[2] = Four{E[8][l], E[9][l], 0.0, 0.0};
  }
  TenRows K;
  for (std::size_t i = 0; i < 10; ++i) {
    Dozen row;
    row.part[2] = Four{0.0, 0.0, R[10 * stride + i], 0.0};
    for (std::size_t l = i; l < 10; ++l) add(row, R[l * stride + i], columns[l]);
    K[i] = row;
  }
  const double damping = std::sqrt(lambda);
  for (std::size_t k = 0; k < 10; ++k) {
    std::array<double, 10> v;
    double square = lambda;
    for (std::size_t i = 0; i < 10; ++i) {
      v[i] = K[i][k];
      square += v[i] * v[i];
    }
    const double length = std::sqrt(square), inverse_length = 1.0 / length;
    const double scale = inverse_length / (length + damping);
    for (std::size_t p = k / 4; p < 3; ++p) {
      Four s = {};
      for (std::size_t i = 0; i < 10; ++i) s += v[i] * K[i].part[p];
      T[k].part[p] = -inverse_length * s;
      s *= scale;
      for (std::size_t i = 0; i < 10; ++i) K[i].part[p] -= v[i] * s;
    }
    inverse[k] = -inverse_length;
  }
}

}  // namespace

void DampedTen::factorise(const Eigen::MatrixXd& R, const LinkDensity::Rows& E,
                          double lambda) noexcept {
  triangularise(R.data(), static_cast<std::size_t>(R.outerStride()), E, lambda, T_, inverse_);
}

void DampedTen::solve(Eigen::VectorXd& y) const noexcept {
  for (int k = 0; k < 10; ++k) y[k] = T_[static_cast<std::size_t>(k)][10];
  back_substitute(y);
}

void DampedTen::solve_normal(Eigen::VectorXd& x) const noexcept {
  for (std::size_t k = 0; k < 10; ++k) {
    double& z = x[static_cast<Eigen::Index>(k)];
    z *= inverse_[k];
    for (std::size_t j = k + 1; j < 10; ++j) x[static_cast<Eigen::Index>(j)] -= T_[k][j] * z;
  }
  back_substitute(x);
}

void DampedTen::back_substitute(Eigen::VectorXd& x) const noexcept {
  for (std::size_t k = 10; k-- > 0;) {
    double& z = x[static_cast<Eigen::Index>(k)];
    z *= inverse_[k];
    for (std::size_t i = 0; i < k; ++i) x[static_cast<Eigen::Index>(i)] -= T_[i][k] * z;
  }
}

}  // namespace shapeid::fast
