#include "shapeid/proofs/certificate/linear.hpp"

#include <array>
#include <optional>
#include <utility>

namespace shapeid::certificate {

Vector solve(std::vector<Vector> A, Vector b) {
  const std::size_t n = b.size();
  std::vector<std::optional<std::size_t>> row_of(n);
  std::size_t next = 0;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = next;
    while (pivot < n && sgn(A[pivot][k]) == 0) ++pivot;
    if (pivot == n) continue;
    std::swap(A[pivot], A[next]);
    std::swap(b[pivot], b[next]);
    for (std::size_t i = next + 1; i < n; ++i) {
      if (sgn(A[i][k]) == 0) continue;
      const Rational factor = A[i][k] / A[next][k];
      for (std::size_t j = k; j < n; ++j) A[i][j] -= factor * A[next][j];
      b[i] -= factor * b[next];
    }
    row_of[k] = next++;
  }
  Vector x(n);
  for (std::size_t k = n; k-- > 0;) {
    if (!row_of[k]) continue;
    const Vector& row = A[*row_of[k]];
    Rational rest = b[*row_of[k]];
    for (std::size_t j = k + 1; j < n; ++j) rest -= row[j] * x[j];
    x[k] = rest / row[k];
  }
  return x;
}

Rational side_of(const Vector& a, const Vector& b, const Vector& c, const Vector& x) {
  const auto from_a = [&](const Vector& to) {
    return std::array<Rational, 3>{to[0] - a[0], to[1] - a[1], to[2] - a[2]};
  };
  const auto u = from_a(b), v = from_a(c), w = from_a(x);
  return w[0] * (u[1] * v[2] - u[2] * v[1]) + w[1] * (u[2] * v[0] - u[0] * v[2]) +
         w[2] * (u[0] * v[1] - u[1] * v[0]);
}

Sign sign_of_form(std::vector<Vector> A) {
  Sign found = Sign::positive;
  for (std::size_t k = 0; k < A.size(); ++k) {
    if (sgn(A[k][k]) < 0) return Sign::indefinite;
    if (sgn(A[k][k]) == 0) {  // then the rest of its row must be zero
      for (std::size_t j = k + 1; j < A.size(); ++j) {
        if (sgn(A[k][j]) != 0) return Sign::indefinite;
      }
      found = Sign::nonnegative;
      continue;
    }
    for (std::size_t i = k + 1; i < A.size(); ++i) {
      const Rational factor = A[i][k] / A[k][k];
      for (std::size_t j = k; j < A.size(); ++j) A[i][j] -= factor * A[k][j];
    }
  }
  return found;
}

}  // namespace shapeid::certificate
