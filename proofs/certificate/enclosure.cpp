#include "shapeid/proofs/certificate/enclosure.hpp"

#include <algorithm>
#include <utility>

namespace shapeid::certificate {
namespace {

constexpr unsigned bits = 128;  // of an enclosure's ends

/// x rounded down to a multiple of 2^-bits.
Rational grid_below(const Rational& x) {
  Rational scaled, rounded;
  mpq_mul_2exp(scaled.get_mpq_t(), x.get_mpq_t(), bits);
  Integer whole;
  mpz_fdiv_q(whole.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
  mpq_div_2exp(rounded.get_mpq_t(), Rational(whole).get_mpq_t(), bits);
  return rounded;
}

/// sum over n = first, first + 2, ... of (-1)^(n / 2) x^n / n!. From the terms that fall on, the
/// rest is smaller than the first one left out.
Enclosure alternating(const Rational& x, int first) {
  Rational term = first == 0 ? Rational(1) : x, sum;
  const Rational square = x * x, small(1, Integer(1) << (bits + 1));
  for (int n = first;; n += 2) {
    const bool falling = square < (n + 1) * (n + 2);
    if (falling && abs(term) < small) break;
    sum += term;
    term *= -square / ((n + 1) * (n + 2));
  }
  const Rational rest = abs(term);
  return {grid_below(sum - rest), -grid_below(-(sum + rest))};
}

}  // namespace

Enclosure operator-(const Enclosure& a) { return {-a.upper, -a.lower}; }

Enclosure operator+(const Enclosure& a, const Enclosure& b) {
  return {a.lower + b.lower, a.upper + b.upper};
}

Enclosure operator-(const Enclosure& a, const Enclosure& b) { return a + -b; }

Enclosure operator*(const Enclosure& a, const Enclosure& b) {
  const auto [lower, upper] =
      std::minmax({Rational(a.lower * b.lower), Rational(a.lower * b.upper),
                   Rational(a.upper * b.lower), Rational(a.upper * b.upper)});
  return {lower, upper};
}

Enclosure operator/(const Enclosure& a, const Enclosure& b) {
  return a * Enclosure{1 / b.upper, 1 / b.lower};
}

Rational distance(const Rational& x, const Enclosure& a) {
  return std::max<Rational>(abs(x - a.lower), abs(x - a.upper));
}

std::optional<SineAndCosine> sine_and_cosine(const Rational& angle) {
  if (abs(angle) > 16) return std::nullopt;
  return SineAndCosine{alternating(angle, 1), alternating(angle, 0)};
}

}  // namespace shapeid::certificate
