// The normal equations of up to a dozen shapes of one link with the passive ones exchanged. Read by
// few_shapes, few_table_pivots and few_table_split alone. Derivation:
// docs/derivations/fast-masses.md.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

#include "shapeid/fast/passive_set.hpp"
#include "shapeid/fast/wide.hpp"

namespace shapeid::fast::few {

inline constexpr std::size_t most_shapes = AtPlaces::most;

/// A column of which less than this share of its square is new counts as dependent: rounding of H
/// may be a hundredth of it.
inline constexpr double smallest_share = 1e-12;

/// What is exchanged.
struct Table {
  std::array<Dozen, most_shapes> H;  ///< of the passive shapes the inverse
  Dozen diagonal;                    ///< of H
  Dozen x;                           ///< masses of the passive shapes, slopes of the others
  Dozen squares;                     ///< the diagonal of H as it was
  Dozen side;                        ///< -1 for passive shapes, 1 for the others
  unsigned passive = 0;              ///< a bit a shape
  int pivots = 0;
};

/// What the table is about.
struct Problem {
  const std::array<Dozen, 10>& U;  ///< a shape a lane
  const LinkRows& link;
  std::size_t shapes;
};

/// What works on a dozen numbers, of which four shapes need but the first four: `parts` of them.
/// What is written beyond is zero.
template <std::size_t parts>
struct Work {
  [[gnu::always_inline]] static void add(Dozen& a, double factor, const Dozen& b) noexcept {
    for (std::size_t p = 0; p < parts; ++p) a.part[p] += factor * b.part[p];
  }

  /// x at one place.
  [[gnu::always_inline]] static void set(Dozen& a, std::size_t place, double x) noexcept {
    for (std::size_t p = 0; p < parts; ++p) {
      a.part[p] = dozen_places[p] == place ? Four{} + x : a.part[p];
    }
  }

  [[gnu::always_inline]] static double dot(const Dozen& a, const Dozen& b) noexcept {
    Four sum = a.part[0] * b.part[0];
    for (std::size_t p = 1; p < parts; ++p) sum += a.part[p] * b.part[p];
    return (sum[0] + sum[2]) + (sum[1] + sum[3]);
  }

  [[gnu::always_inline]] static double largest(const Four (&x)[parts]) noexcept {
    Four most = x[0];
    for (std::size_t p = 1; p < parts; ++p) most = x[p] > most ? x[p] : most;
    return std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
  }
};

/// use(parts) with as many as the shapes need, a constant.
template <typename Use>
[[gnu::always_inline]] inline auto by_parts(std::size_t shapes, Use use) noexcept {
  if (shapes <= 4) return use(std::integral_constant<std::size_t, 1>());
  if (shapes <= 8) return use(std::integral_constant<std::size_t, 2>());
  return use(std::integral_constant<std::size_t, 3>());
}

/// What tells the next exchange, in registers from one to the next; the table has the same numbers
/// where single ones are read.
template <std::size_t parts>
struct alignas(32) Front {
  Four x[parts], diagonal[parts], side[parts];

  [[gnu::always_inline]] explicit Front(const Table& now) noexcept {
    for (std::size_t p = 0; p < parts; ++p) {
      x[p] = now.x.part[p];
      diagonal[p] = now.diagonal.part[p];
      side[p] = now.side.part[p];
    }
  }
};

/// The exchange of x_k and its slope in  slope = q - H x,  for either direction. Column k is row
/// k but for the signs of the rows on the other side. Entries k are set among their neighbours:
/// what is written in part is slow to read as a whole.
template <std::size_t parts>
[[gnu::always_inline]] inline void exchange(Table& now, Front<parts>& front, std::size_t shapes,
                                            std::size_t k, double inverse) noexcept {
  Dozen row = now.H[k], column;
  FourBits others[parts];
  const double step = inverse * now.x[k], same = now.side[k];
  for (std::size_t p = 0; p < parts; ++p) {
    const auto is_k = dozen_places[p] == k;
    others[p] = reinterpret_cast<FourBits>(~is_k);
    Four &side = front.side[p], &x = front.x[p], &diagonal = front.diagonal[p];
    column.part[p] = same * side * row.part[p];
    row.part[p] = is_k ? Four{} + inverse : inverse * row.part[p];
    now.x.part[p] = x = is_k ? Four{} + step : x - step * column.part[p];
    now.diagonal.part[p] = diagonal =
        is_k ? Four{} + inverse : diagonal - column.part[p] * row.part[p];
    now.side.part[p] = side = is_k ? -side : side;
  }
  for (std::size_t i = 0; i < shapes; ++i) {
    for (std::size_t p = 0; p < parts; ++p) {
      Four& entry = now.H[i].part[p];
      entry = reinterpret_cast<Four>(reinterpret_cast<FourBits>(entry) & others[p]);
      entry -= column[i] * row.part[p];
    }
  }
  now.H[k] = row;
  now.passive ^= 1U << k;
  ++now.pivots;
}

template <std::size_t parts>
[[gnu::always_inline]] inline void exchange(Table& now, std::size_t shapes, std::size_t k,
                                            double inverse) noexcept {
  Front<parts> front(now);
  exchange(now, front, shapes, k, inverse);
}

}  // namespace shapeid::fast::few
