#include "shapeid/proofs/certificate/rational.hpp"

#include <cmath>
#include <limits>

namespace shapeid::certificate {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<double>::max();

Rational sum_of(const Vector& terms, std::size_t begin, std::size_t end) {
  if (begin == end) return 0;
  if (end - begin == 1) return terms[begin];
  const std::size_t middle = begin + (end - begin) / 2;
  return sum_of(terms, begin, middle) + sum_of(terms, middle, end);
}

}  // namespace

long exponent_of(const Rational& x) {
  return static_cast<long>(mpz_sizeinbase(x.get_num_mpz_t(), 2)) -
         static_cast<long>(mpz_sizeinbase(x.get_den_mpz_t(), 2)) + 1;
}

Rational scaled(const Rational& x, long exponent) {
  Rational y;
  if (exponent >= 0) {
    mpq_mul_2exp(y.get_mpq_t(), x.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
  } else {
    mpq_div_2exp(y.get_mpq_t(), x.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent));
  }
  return y;
}

Vector exact(const Eigen::VectorXd& v) {
  Vector x;
  x.reserve(static_cast<std::size_t>(v.size()));
  for (const double value : v) x.emplace_back(value);
  return x;
}

double rounded_down(const Rational& x) {
  if (x < exact(-largest)) return -infinity;
  if (x > exact(largest)) return largest;
  double d = x.get_d();
  while (exact(d) > x) d = std::nextafter(d, -infinity);
  for (double next = std::nextafter(d, infinity); next <= largest && exact(next) <= x;) {
    d = next;
    next = std::nextafter(d, infinity);
  }
  return d;
}

double rounded_up(const Rational& x) { return 0.0 - rounded_down(-x); }

Rational root_above(const Rational& x) {
  if (sgn(x) == 0) return 0;
  constexpr long bits = 64;  // of the root
  const long half = bits - exponent_of(x) / 2;
  const Rational square = scaled(x, 2 * half);
  Integer whole, root, rest;
  mpz_cdiv_q(whole.get_mpz_t(), square.get_num_mpz_t(), square.get_den_mpz_t());
  mpz_sqrtrem(root.get_mpz_t(), rest.get_mpz_t(), whole.get_mpz_t());
  if (rest != 0) ++root;
  return scaled(Rational(root), -half);
}

Rational sum(const Vector& terms) { return sum_of(terms, 0, terms.size()); }

Rational dot(const Vector& a, const Vector& b) {
  Vector terms;
  terms.reserve(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (sgn(a[i]) != 0 && sgn(b[i]) != 0) terms.emplace_back(a[i] * b[i]);
  }
  return sum(terms);
}

}  // namespace shapeid::certificate
