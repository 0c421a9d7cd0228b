// Sixteen shapes of a link beside each other in memory, priced in single precision.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {

/// What a barred shape's price is lowered by. Prices lie in [-1, 1].
constexpr float barred = 1e30F;
/// And what no price reaches, unless products overflowed.
constexpr float no_price = 2.0F, impossible = 4.0F;

/// A price further from zero than this has the sign that it shows: its sum carries eight roundings
/// of terms whose sizes add up to one (operands, product, additions); the rest is for the scale.
constexpr float uncertain = 13.0F / (1 << 24);

using EightNumbers = std::int32_t __attribute__((vector_size(32)));
alignas(32) constexpr EightNumbers lane_numbers[] = {{0, 1, 2, 3, 4, 5, 6, 7},
                                                     {8, 9, 10, 11, 12, 13, 14, 15}};

/// Sixteen shapes of one link. Missing ones are barred.
struct alignas(64) PriceChunk {
  static constexpr int lanes = 16;
  using Prices = Eigen::Array<float, lanes, 1>;
  Eigen::Array<float, lanes, 10> U;
  Prices scale;    ///< 1 / sum_i |u_ij| lengths_i
  Prices barrier;  ///< 0, or barred
  Prices last;     ///< by which the last pricing could not decide
  std::array<int, lanes> shape;
  int link;
  int used;
  bool is_behind;  ///< columns were written that are not here yet
};

/// A shape of a chunk.
struct Lane {
  PriceChunk* chunk = nullptr;
  std::size_t lane = 0;

  [[nodiscard]] int shape() const noexcept { return chunk->shape[lane]; }
  [[nodiscard]] double scale() const noexcept {
    return static_cast<double>(chunk->scale.data()[lane]);
  }
  /// Writes the barrier among those of its neighbours: what is written in part is slow to read as a
  /// whole, and pricing reads it next.
  [[gnu::always_inline]] void bar(float barrier) const noexcept {
    for (std::ptrdiff_t p = 0; p < 2; ++p) {
      float* eight = chunk->barrier.data() + 8 * p;
      Eight all;
      load(eight, all);
      all = lane_numbers[p] == static_cast<int>(lane) ? Eight{} + barrier : all;
      store(all, eight);
    }
  }
};

/// The best price of a chunk.
struct Best {
  float price;
  std::size_t lane;
};

/// u . g of sixteen shapes, in two sums, so that one addition need not wait for the other.
[[gnu::always_inline]] inline void slopes_of(const float* U, const float* g,
                                             Eight* slopes) noexcept {
  for (std::ptrdiff_t p = 0; p < 2; ++p) {
    Eight even = {}, odd = {};
    for (std::ptrdiff_t i = 0; i < 10; i += 2) {
      Eight u, v;
      load(U + 16 * i + 8 * p, u);
      load(U + 16 * (i + 1) + 8 * p, v);
      even += u * g[i];
      odd += v * g[i + 1];
    }
    slopes[p] = even + odd;
  }
}

/// The largest price and its lane; `impossible` if one of them cannot be a price. The lane's number
/// is written into the last four bits of its price, which single precision cannot vouch for anyway:
/// then one maximum finds both.
[[gnu::always_inline]] inline Best best_of(const Eight* prices) noexcept {
  Eight most[2];
  for (std::ptrdiff_t p = 0; p < 2; ++p) {
    const Eight possible = prices[p] <= no_price ? prices[p] : Eight{} + impossible;
    most[p] = reinterpret_cast<Eight>((reinterpret_cast<EightBits>(possible) & ~15U) |
                                      reinterpret_cast<EightBits>(lane_numbers[p]));
  }
  const Eight m = most[0] > most[1] ? most[0] : most[1];
  const float best = std::max(std::max(std::max(m[0], m[1]), std::max(m[2], m[3])),
                              std::max(std::max(m[4], m[5]), std::max(m[6], m[7])));
  return {best, std::bit_cast<std::uint32_t>(best) & 15U};
}

/// Prices of sixteen shapes by their lengths, for the slopes g of their link.
[[gnu::always_inline]] inline Best price(PriceChunk& chunk, const float* g) noexcept {
  Eight slopes[2];
  slopes_of(chunk.U.data(), g, slopes);
  for (std::ptrdiff_t p = 0; p < 2; ++p) {
    Eight factor, barred_by;
    load(chunk.scale.data() + 8 * p, factor);
    load(chunk.barrier.data() + 8 * p, barred_by);
    slopes[p] = slopes[p] * factor - barred_by;
    store(slopes[p], chunk.last.data() + 8 * p);
  }
  return best_of(slopes);
}

}  // namespace shapeid::fast
