// Small dense systems of rationals.
#pragma once

#include <vector>

#include "shapeid/proofs/certificate/rational.hpp"

namespace shapeid::certificate {

/// A solution of A x = b, which must have one (normal equations always do), by elimination;
/// unknowns without a pivot are zero.
[[nodiscard]] Vector solve(std::vector<Vector> A, Vector b);

/// Of the form x^T A x, A symmetric: positive but at zero, nowhere negative, or negative somewhere.
enum class Sign { positive, nonnegative, indefinite };

/// Decided by elimination.
[[nodiscard]] Sign sign_of_form(std::vector<Vector> A);

}  // namespace shapeid::certificate
