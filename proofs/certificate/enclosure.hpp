// Numbers that are not fractions, such as sines, between two fractions.
#pragma once

#include <optional>

#include "shapeid/proofs/certificate/rational.hpp"

namespace shapeid::certificate {

/// Some number of [lower, upper].
struct Enclosure {
  Rational lower, upper;

  Enclosure() = default;
  // A fraction is its own enclosure: formulas read alike for both.
  Enclosure(Rational x) : lower(x), upper(std::move(x)) {}  // NOLINT(google-explicit-constructor)
  Enclosure(int x) : Enclosure(Rational(x)) {}              // NOLINT(google-explicit-constructor)
  Enclosure(Rational low, Rational high) : lower(std::move(low)), upper(std::move(high)) {}
};

[[nodiscard]] Enclosure operator-(const Enclosure& a);
[[nodiscard]] Enclosure operator+(const Enclosure& a, const Enclosure& b);
[[nodiscard]] Enclosure operator-(const Enclosure& a, const Enclosure& b);
[[nodiscard]] Enclosure operator*(const Enclosure& a, const Enclosure& b);
/// b does not hold zero.
[[nodiscard]] Enclosure operator/(const Enclosure& a, const Enclosure& b);

/// The largest distance of x from a number of the enclosure.
[[nodiscard]] Rational distance(const Rational& x, const Enclosure& a);

struct SineAndCosine {
  Enclosure sine, cosine;  ///< no wider than 2^-120
};

/// By Taylor's series with its remainder. Empty beyond 16 rad: no cell of a shape turns so far.
[[nodiscard]] std::optional<SineAndCosine> sine_and_cosine(const Rational& angle);

}  // namespace shapeid::certificate
