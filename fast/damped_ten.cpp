#include "shapeid/fast/damped_ten.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace shapeid::fast {
namespace {

/// Reflection k joins row k of lambda^(1/2) I, which has nothing but its diagonal entry until then,
/// with all rows of K below it. `first`: the part of a row that has place k. Makes row k of the
/// triangle, and 1 over its diagonal entry.
template <std::size_t first>
[[gnu::always_inline]] inline double reflect(std::size_t k, double lambda, double damping,
                                             TenRows& K, Dozen& row) noexcept {
  // Products of column k with all columns, its own among them, in two sums, so that one addition
  // need not wait for the other.
  std::array<double, 10> v;
  for (std::size_t i = 0; i < 10; ++i) v[i] = K[i][k];
  Dozen s;
  for (std::size_t p = first; p < 3; ++p) {
    Four even = {}, odd = {};
    for (std::size_t i = 0; i < 10; i += 2) {
      even += v[i] * K[i].part[p];
      odd += v[i + 1] * K[i + 1].part[p];
    }
    s.part[p] = even + odd;
  }
  const double length = std::sqrt(lambda + s[k]), inverse_length = 1.0 / length;
  const double scale = 1.0 / (length * (length + damping));
  for (std::size_t p = first; p < 3; ++p) {
    row.part[p] = -inverse_length * s.part[p];
    s.part[p] *= scale;
    for (std::size_t i = 0; i < 10; ++i) K[i].part[p] -= v[i] * s.part[p];
  }
  return -inverse_length;
}

/// Householder's QR of [lambda^(1/2) I 0; R E^T c], of which the first `rank` rows of E are not
/// zero.
SHAPEID_WIDE void triangularise(const double* R, std::size_t stride, const TenRows& E,
                                std::size_t rank, double lambda, TenRows& rows, TenRows& columns,
                                Dozen& inverse, Dozen& right) noexcept {
  TenRows K, T;
  transpose_ten(E, columns);  // an entry an unknown
  for (std::size_t i = 0; i < 10; ++i) {
    Dozen row;
    row.part[2] = Four{0.0, 0.0, R[10 * stride + i], 0.0};
    for (std::size_t l = i; l < 10; ++l) add(row, R[l * stride + i], columns[l]);
    K[i] = row;
  }
  const double damping = std::sqrt(lambda);
  std::array<double, 10> over;
  over.fill(1.0 / damping);
  for (std::size_t k = 0; k < std::min(rank, std::size_t{4}); ++k) {
    over[k] = reflect<0>(k, lambda, damping, K, T[k]);
  }
  for (std::size_t k = 4; k < std::min(rank, std::size_t{8}); ++k) {
    over[k] = reflect<1>(k, lambda, damping, K, T[k]);
  }
  for (std::size_t k = 8; k < rank; ++k) over[k] = reflect<2>(k, lambda, damping, K, T[k]);
  load_ten(over.data(), inverse);
  transpose_ten(T, columns);
  for (std::size_t k = 0; k < 10; ++k) {
    right[k] = T[k][10];
    rows[k] = T[k];
    scale_beside(Beside::behind, k, over[k], rows[k]);
    scale_beside(Beside::before, k, over[k], columns[k]);
  }
}

SHAPEID_WIDE void substitute(const TenRows& columns, const Dozen& inverse, const Dozen& right,
                             double* y) noexcept {
  Dozen x = right;
  solve_above<9>(columns, x);
  for (std::size_t p = 0; p < 3; ++p) x.part[p] *= inverse.part[p];
  store_ten(x, y);
}

SHAPEID_WIDE void substitute_twice(const TenRows& rows, const TenRows& columns,
                                   const Dozen& inverse, double* y) noexcept {
  Dozen x;
  load_ten(y, x);
  solve_below<0>(rows, x);
  for (std::size_t p = 0; p < 3; ++p) x.part[p] *= inverse.part[p];
  solve_above<9>(columns, x);
  for (std::size_t p = 0; p < 3; ++p) x.part[p] *= inverse.part[p];
  store_ten(x, y);
}

}  // namespace

void DampedTen::factorise(const Eigen::MatrixXd& R, const TenRows& E, int rank,
                          double lambda) noexcept {
  triangularise(R.data(), static_cast<std::size_t>(R.outerStride()), E,
                static_cast<std::size_t>(rank), lambda, rows_, columns_, inverse_, right_);
}

void DampedTen::solve(Eigen::VectorXd& y) const noexcept {
  substitute(columns_, inverse_, right_, y.data());
}

void DampedTen::solve_normal(Eigen::VectorXd& x) const noexcept {
  substitute_twice(rows_, columns_, inverse_, x.data());
}

}  // namespace shapeid::fast
