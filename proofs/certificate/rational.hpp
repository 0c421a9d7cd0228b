// Exact numbers, and the doubles on either side of them.
#pragma once

#include <gmpxx.h>

#include <Eigen/Core>

#include <vector>

namespace shapeid::certificate {

using Integer = mpz_class;
using Rational = mpq_class;
using Vector = std::vector<Rational>;

/// The rational that a finite double is.
[[nodiscard]] inline Rational exact(double x) { return Rational(x); }
[[nodiscard]] Vector exact(const Eigen::VectorXd& v);

/// The largest double that is not above x (minus infinity if there is none), and the smallest that
/// is not below.
[[nodiscard]] double rounded_down(const Rational& x);
[[nodiscard]] double rounded_up(const Rational& x);

/// A number that is not below the root of x >= 0, nor above it by more than 2^-60 of it.
[[nodiscard]] Rational root_above(const Rational& x);

/// x / 2^exponent lies in [1/4, 1) for x > 0, whatever the size of its numerator.
[[nodiscard]] long exponent_of(const Rational& x);

/// x 2^exponent.
[[nodiscard]] Rational scaled(const Rational& x, long exponent);

/// By halves: sums of many fractions with different denominators stay cheap.
[[nodiscard]] Rational sum(const Vector& terms);

[[nodiscard]] Rational dot(const Vector& a, const Vector& b);

}  // namespace shapeid::certificate
