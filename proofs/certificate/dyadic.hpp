// Matrices of doubles as integers times one power of two: several times faster than rationals, and
// just as exact. Fractions over one denominator are what exact solutions of their systems are.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "shapeid/proofs/certificate/rational.hpp"

namespace shapeid::certificate {

/// The matrix entries x 2^exponent.
struct Dyadic {
  std::size_t rows = 0, columns = 0;
  std::vector<Integer> entries;  ///< row by row
  long exponent = 0;

  Dyadic() = default;
  Dyadic(std::size_t r, std::size_t c) : rows(r), columns(c), entries(r * c) {}
  /// Exactly these doubles, which must be finite.
  explicit Dyadic(const Eigen::MatrixXd& M);

  [[nodiscard]] Integer& at(std::size_t i, std::size_t j) { return entries[i * columns + j]; }
  [[nodiscard]] const Integer& at(std::size_t i, std::size_t j) const {
    return entries[i * columns + j];
  }
};

[[nodiscard]] Dyadic operator*(const Dyadic& A, const Dyadic& B);
[[nodiscard]] Dyadic operator+(Dyadic A, Dyadic B);
[[nodiscard]] Dyadic operator-(Dyadic A);
[[nodiscard]] Dyadic transposed(const Dyadic& A);
/// diag(d) A, with d one column.
[[nodiscard]] Dyadic scaled_rows(const Dyadic& d, Dyadic A);
[[nodiscard]] Dyadic chosen_columns(const Dyadic& A, const std::vector<std::size_t>& chosen);
/// [A B] and [A; B].
[[nodiscard]] Dyadic beside(Dyadic A, Dyadic B);
[[nodiscard]] Dyadic below(const Dyadic& A, const Dyadic& B);

/// A Dyadic over a positive integer. Sums need the same denominator on both sides.
struct Fractions {
  Dyadic numerators;
  Integer denominator = 1;

  /// Entry (i, j), reduced.
  [[nodiscard]] Rational at(std::size_t i, std::size_t j = 0) const;
};

/// The same denominator for a matrix that has none.
[[nodiscard]] Fractions over(const Integer& denominator, Dyadic A);
[[nodiscard]] Fractions operator*(const Dyadic& A, const Fractions& x);
[[nodiscard]] Fractions operator+(const Fractions& a, const Fractions& b);

}  // namespace shapeid::certificate
