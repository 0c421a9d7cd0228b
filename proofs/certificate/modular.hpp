// Arithmetic modulo a prime below 2^62: where exact solutions begin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "shapeid/proofs/certificate/dyadic.hpp"

namespace shapeid::certificate {

class PrimeField {
 public:
  using Element = std::uint64_t;

  /// `p` prime, below 2^62.
  explicit PrimeField(Element p) : p_(p) {}

  [[nodiscard]] Element p() const { return p_; }
  [[nodiscard]] Element of(const Integer& x) const { return mpz_fdiv_ui(x.get_mpz_t(), p_); }
  [[nodiscard]] Element times(Element a, Element b) const {
    return static_cast<Element>(static_cast<Wide>(a) * b % p_);
  }
  [[nodiscard]] Element minus(Element a, Element b) const { return a >= b ? a - b : a + p_ - b; }
  [[nodiscard]] Element inverse(Element a) const;
  [[nodiscard]] Element dot(const Element* a, const Element* b, std::size_t n) const;

 private:
  __extension__ using Wide = unsigned __int128;
  Element p_;
};

/// The first prime above `start`, which must be below 2^61.
[[nodiscard]] PrimeField::Element next_prime(PrimeField::Element start);

/// Row by row, modulo p; the powers of two are left out.
[[nodiscard]] std::vector<PrimeField::Element> reduced(const Dyadic& A, const PrimeField& field);

/// Inverse of an n x n matrix, row by row; empty if it is singular modulo p.
[[nodiscard]] std::optional<std::vector<PrimeField::Element>> inverse(
    std::vector<PrimeField::Element> A, std::size_t n, const PrimeField& field);

/// Pivot columns of a matrix, from the left.
[[nodiscard]] std::vector<std::size_t> pivot_columns(std::vector<PrimeField::Element> A,
                                                     std::size_t rows, std::size_t columns,
                                                     const PrimeField& field);

}  // namespace shapeid::certificate
