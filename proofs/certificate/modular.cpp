#include "shapeid/proofs/certificate/modular.hpp"

#include <algorithm>

namespace shapeid::certificate {
namespace {

using Element = PrimeField::Element;

/// row -= factor * other, from column `from` on.
void subtract(Element* row, const Element* other, Element factor, std::size_t from, std::size_t to,
              const PrimeField& field) {
  for (std::size_t j = from; j < to; ++j) {
    if (other[j] != 0) row[j] = field.minus(row[j], field.times(factor, other[j]));
  }
}

}  // namespace

Element PrimeField::inverse(Element a) const {  // a^(p - 2)
  Element result = 1;
  for (Element power = p_ - 2; power > 0; power >>= 1U, a = times(a, a)) {
    if ((power & 1U) != 0) result = times(result, a);
  }
  return result;
}

Element PrimeField::dot(const Element* a, const Element* b, std::size_t n) const {
  constexpr std::size_t fit = 16;  // products below 2^124 that 128 bits hold
  Wide total = 0;
  for (std::size_t i = 0; i < n; ++i) {
    total += static_cast<Wide>(a[i]) * b[i];
    if (i % fit == fit - 2) total %= p_;
  }
  return static_cast<Element>(total % p_);
}

Element next_prime(Element start) {
  Integer prime(static_cast<unsigned long>(start));
  mpz_nextprime(prime.get_mpz_t(), prime.get_mpz_t());
  return prime.get_ui();
}

std::vector<Element> reduced(const Dyadic& A, const PrimeField& field) {
  std::vector<Element> entries;
  entries.reserve(A.entries.size());
  for (const Integer& entry : A.entries) entries.push_back(field.of(entry));
  return entries;
}

std::optional<std::vector<Element>> inverse(std::vector<Element> A, std::size_t n,
                                            const PrimeField& field) {
  std::vector<Element> B(n * n, 0);
  for (std::size_t i = 0; i < n; ++i) B[i * n + i] = 1;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    while (pivot < n && A[pivot * n + k] == 0) ++pivot;
    if (pivot == n) return std::nullopt;
    if (pivot != k) {
      std::swap_ranges(&A[k * n], &A[k * n] + n, &A[pivot * n]);
      std::swap_ranges(&B[k * n], &B[k * n] + n, &B[pivot * n]);
    }
    const Element scale = field.inverse(A[k * n + k]);
    for (std::size_t j = 0; j < n; ++j) {
      A[k * n + j] = field.times(A[k * n + j], scale);
      B[k * n + j] = field.times(B[k * n + j], scale);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Element factor = A[i * n + k];
      if (i == k || factor == 0) continue;
      subtract(&A[i * n], &A[k * n], factor, k, n, field);
      subtract(&B[i * n], &B[k * n], factor, 0, n, field);
    }
  }
  return B;
}

std::vector<std::size_t> pivot_columns(std::vector<Element> A, std::size_t rows,
                                       std::size_t columns, const PrimeField& field) {
  std::vector<std::size_t> pivots;
  for (std::size_t j = 0; j < columns && pivots.size() < rows; ++j) {
    const std::size_t k = pivots.size();
    std::size_t pivot = k;
    while (pivot < rows && A[pivot * columns + j] == 0) ++pivot;
    if (pivot == rows) continue;
    if (pivot != k) {
      std::swap_ranges(&A[k * columns], &A[k * columns] + columns, &A[pivot * columns]);
    }
    const Element scale = field.inverse(A[k * columns + j]);
    for (std::size_t i = k + 1; i < rows; ++i) {
      const Element factor = field.times(A[i * columns + j], scale);
      if (factor != 0) subtract(&A[i * columns], &A[k * columns], factor, j, columns, field);
    }
    pivots.push_back(j);
  }
  return pivots;
}

}  // namespace shapeid::certificate
