// Linear systems of integers, solved exactly by p-adic lifting (Dixon 1982).
#pragma once

#include <optional>
#include <vector>

#include "shapeid/proofs/certificate/dyadic.hpp"

namespace shapeid::certificate {

/// The x with A x = b, checked by multiplying; A square, b one column. Empty if A is singular (or
/// singular modulo each of a few primes, which does not happen by accident).
[[nodiscard]] std::optional<Fractions> solve(const Dyadic& A, const Dyadic& b);

/// Columns, the first that can be taken, that span all of A's: independent in any case, and as many
/// as the rank unless a prime of 62 bits divides a determinant by accident.
[[nodiscard]] std::vector<std::size_t> independent_columns(const Dyadic& A);

}  // namespace shapeid::certificate
