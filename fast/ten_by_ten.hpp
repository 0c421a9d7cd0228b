// Triangles of ten, four numbers at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {

using TenRows = std::array<Dozen, 10>;

/// Columns of the ten rows, of which ten entries are read.
[[gnu::always_inline]] inline void transpose_ten(const TenRows& rows, TenRows& columns) noexcept {
  for (std::size_t p = 0; p < 3; ++p) {
    for (std::size_t q = 0; q < 3; ++q) {
      const std::size_t there = q < 2 ? 4 : 2;
      Four block[4] = {};
      for (std::size_t i = 0; i < there; ++i) block[i] = rows[4 * q + i].part[p];
      transpose(block);
      for (std::size_t i = 0; i < (p < 2 ? 4 : 2); ++i) columns[4 * p + i].part[q] = block[i];
    }
  }
}

/// Of row or column k what stands before place k, or behind it, times `factor`; zeros elsewhere.
enum class Beside { before, behind };
[[gnu::always_inline]] inline void scale_beside(Beside side, std::size_t k, double factor,
                                                Dozen& x) noexcept {
  const FourBits at = FourBits{} + std::uint64_t{k};
  for (std::size_t p = 0; p < 3; ++p) {
    const Four scaled = factor * x.part[p];
    const auto kept = side == Beside::before ? dozen_places[p] < at : dozen_places[p] > at;
    x.part[p] = kept ? scaled : Four{};
  }
}

/// One number of a dozen, four times.
template <std::size_t k>
[[gnu::always_inline]] inline void all_alike(const Dozen& x, Four& all) noexcept {
  all = __builtin_shufflevector(x.part[k / 4], x.part[k / 4], k % 4, k % 4, k % 4, k % 4);
}

/// Solves a triangle whose diagonal is one, in place: from unknown `k` down, what stands above the
/// diagonal being column k, zero elsewhere. (A template, because a place that is known when this is
/// compiled is a permutation of a register, and one that is not goes through memory.)
template <std::size_t k>
[[gnu::always_inline]] inline void solve_above(const TenRows& columns, Dozen& x) noexcept {
  Four found;
  all_alike<k>(x, found);
  for (std::size_t p = 0; p <= k / 4; ++p) x.part[p] -= found * columns[k].part[p];
  if constexpr (k > 1) solve_above<k - 1>(columns, x);
}

/// The same from unknown `k` up, what stands below the diagonal being row k of the transposed.
template <std::size_t k>
[[gnu::always_inline]] inline void solve_below(const TenRows& rows, Dozen& x) noexcept {
  Four found;
  all_alike<k>(x, found);
  for (std::size_t p = k / 4; p < 3; ++p) x.part[p] -= found * rows[k].part[p];
  if constexpr (k < 8) solve_below<k + 1>(rows, x);
}

}  // namespace shapeid::fast
