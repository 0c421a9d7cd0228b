#include "shapeid/proofs/certificate/dyadic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace shapeid::certificate {
namespace {

constexpr int mantissa_bits = std::numeric_limits<double>::digits;

void lower_exponent(Dyadic& A, long exponent) {
  const auto shift = static_cast<mp_bitcnt_t>(A.exponent - exponent);
  for (Integer& entry : A.entries) entry <<= shift;
  A.exponent = exponent;
}

void align(Dyadic& A, Dyadic& B) {
  const long exponent = std::min(A.exponent, B.exponent);
  lower_exponent(A, exponent);
  lower_exponent(B, exponent);
}

}  // namespace

Dyadic::Dyadic(const Eigen::MatrixXd& M)
    : Dyadic(static_cast<std::size_t>(M.rows()), static_cast<std::size_t>(M.cols())) {
  int least = std::numeric_limits<int>::max();
  for (const double x : M.reshaped()) {
    int power = 0;
    if (std::frexp(x, &power) != 0.0) least = std::min(least, power - mantissa_bits);
  }
  if (least == std::numeric_limits<int>::max()) return;  // all zero
  exponent = least;
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    for (Eigen::Index j = 0; j < M.cols(); ++j) {
      int power = 0;
      const double mantissa = std::ldexp(std::frexp(M(i, j), &power), mantissa_bits);
      if (mantissa == 0.0) continue;
      Integer& entry = at(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
      entry = mantissa;
      entry <<= static_cast<mp_bitcnt_t>(power - mantissa_bits - least);
    }
  }
}

Dyadic operator*(const Dyadic& A, const Dyadic& B) {
  Dyadic product(A.rows, B.columns);
  product.exponent = A.exponent + B.exponent;
  for (std::size_t i = 0; i < A.rows; ++i) {
    for (std::size_t k = 0; k < A.columns; ++k) {
      const Integer& a = A.at(i, k);
      if (sgn(a) == 0) continue;
      for (std::size_t j = 0; j < B.columns; ++j) {
        const Integer& b = B.at(k, j);
        if (sgn(b) != 0) {
          mpz_addmul(product.at(i, j).get_mpz_t(), a.get_mpz_t(), b.get_mpz_t());
        }
      }
    }
  }
  return product;
}

Dyadic operator+(Dyadic A, Dyadic B) {
  align(A, B);
  for (std::size_t i = 0; i < A.entries.size(); ++i) A.entries[i] += B.entries[i];
  return A;
}

Dyadic operator-(Dyadic A) {
  for (Integer& entry : A.entries) entry = -entry;
  return A;
}

Dyadic transposed(const Dyadic& A) {
  Dyadic T(A.columns, A.rows);
  T.exponent = A.exponent;
  for (std::size_t i = 0; i < A.rows; ++i) {
    for (std::size_t j = 0; j < A.columns; ++j) T.at(j, i) = A.at(i, j);
  }
  return T;
}

Dyadic scaled_rows(const Dyadic& d, Dyadic A) {
  for (std::size_t i = 0; i < A.rows; ++i) {
    for (std::size_t j = 0; j < A.columns; ++j) A.at(i, j) *= d.entries[i];
  }
  A.exponent += d.exponent;
  return A;
}

Dyadic chosen_columns(const Dyadic& A, const std::vector<std::size_t>& chosen) {
  Dyadic B(A.rows, chosen.size());
  B.exponent = A.exponent;
  for (std::size_t i = 0; i < A.rows; ++i) {
    for (std::size_t k = 0; k < chosen.size(); ++k) B.at(i, k) = A.at(i, chosen[k]);
  }
  return B;
}

Dyadic beside(Dyadic A, Dyadic B) {
  align(A, B);
  Dyadic AB(A.rows, A.columns + B.columns);
  AB.exponent = A.exponent;
  for (std::size_t i = 0; i < A.rows; ++i) {
    for (std::size_t j = 0; j < A.columns; ++j) AB.at(i, j) = A.at(i, j);
    for (std::size_t j = 0; j < B.columns; ++j) AB.at(i, A.columns + j) = B.at(i, j);
  }
  return AB;
}

Dyadic below(const Dyadic& A, const Dyadic& B) {
  return transposed(beside(transposed(A), transposed(B)));
}

Rational Fractions::at(std::size_t i, std::size_t j) const {
  Rational x(numerators.at(i, j), denominator);
  x.canonicalize();
  const auto shift = static_cast<mp_bitcnt_t>(std::abs(numerators.exponent));
  return numerators.exponent < 0 ? Rational(x >> shift) : Rational(x << shift);
}

Fractions over(const Integer& denominator, Dyadic A) {
  for (Integer& entry : A.entries) entry *= denominator;
  return {std::move(A), denominator};
}

Fractions operator*(const Dyadic& A, const Fractions& x) {
  return {A * x.numerators, x.denominator};
}

Fractions operator+(const Fractions& a, const Fractions& b) {
  if (a.denominator != b.denominator) throw std::logic_error("fractions over two denominators");
  return {a.numerators + b.numerators, a.denominator};
}

}  // namespace shapeid::certificate
