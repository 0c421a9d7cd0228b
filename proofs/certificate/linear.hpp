// Small dense systems of rationals.
#pragma once

#include <vector>

#include "shapeid/proofs/certificate/rational.hpp"

namespace shapeid::certificate {

/// A solution of A x = b, which must have one (normal equations always do), by elimination;
/// unknowns without a pivot are zero.
[[nodiscard]] Vector solve(std::vector<Vector> A, Vector b);

/// Six times the volume of the tetrahedron a, b, c, x in space: above zero where x lies on the side
/// from which a, b, c run counter-clockwise.
[[nodiscard]] Rational side_of(const Vector& a, const Vector& b, const Vector& c, const Vector& x);

/// Of the form x^T A x, A symmetric: positive but at zero, nowhere negative, or negative somewhere.
enum class Sign { positive, nonnegative, indefinite };

/// Decided by elimination.
[[nodiscard]] Sign sign_of_form(std::vector<Vector> A);

}  // namespace shapeid::certificate
