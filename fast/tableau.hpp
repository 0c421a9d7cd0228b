// The exchange tableau of one link's masses, for principal pivots in its ten parameters. Read by
// link_table, tableau_pivots and tableau_split alone. Derivation: docs/derivations/fast-masses.md.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include "shapeid/fast/link_rows.hpp"
#include "shapeid/fast/price_chunk.hpp"
#include "shapeid/fast/wide.hpp"

namespace shapeid::fast::tableau {

/// More passive shapes are not dealt with.
inline constexpr std::size_t most_passive = AtPlaces::most;

/// A column of which less than this share of its bound's square is new counts as dependent:
/// rounding of M may be a hundredth of it.
inline constexpr double smallest_share = 1e-12;

/// What is exchanged. Places that no shape has: zero, and in `m` and `diagonal` one;
/// rows of K are written as shapes enter.
struct Tableau {
  std::array<Dozen, 10> M, C;
  std::array<Dozen, 10> U;            ///< a place's column in each lane, until it is used anew
  std::array<Dozen, most_passive> K;  ///< a row a place
  Dozen g, m, diagonal;               ///< `diagonal`: of K
  Dozen sizes;                        ///< what bounds the columns of A
  std::array<int, most_passive> shape{};
  std::array<Lane, most_passive> lane{};  ///< where they are priced
  std::size_t places = 0;                 ///< in use, with gaps
  unsigned used = 0;                      ///< a bit a place
  int count = 0;                          ///< of these
};

/// What the tableau is about.
struct Problem {
  const double* U = nullptr;  ///< ten numbers a shape
  const double* V = nullptr;  ///< m^3
  double lambda = 0.0;
  double largest = 0.0;         ///< length of the columns of R
  double inverse_unit = 0.0;    ///< what makes slopes prices, but for a shape's scale
  double inverse_length = 0.0;  ///< of the right-hand side, or zero
  double smallest_left = 0.0;   ///< of a column's square, times that of its scale
  Dozen inverse_lengths;        ///< of the columns of R, or zero
  PriceChunk* chunks = nullptr;
  int count = 0;  ///< of them

  [[nodiscard]] double stiffness(int j) const noexcept {
    return lambda > 0.0 ? lambda / V[j] : 0.0;
  }
};

/// Whether there are as many passive shapes as rows: then no row is left that a slope could come
/// from.
[[gnu::always_inline]] inline bool is_full(const Tableau& t, const Problem& problem) noexcept {
  return problem.lambda == 0.0 && t.count == 10;
}

/// The first place that is free; most_passive if none is.
[[gnu::always_inline]] inline std::size_t free_place(const Tableau& t) noexcept {
  return static_cast<std::size_t>(std::countr_one(t.used));
}

/// All bits at the places but one.
struct Others {
  FourBits part[3];
};

[[gnu::always_inline]] inline Others others_than(std::size_t place) noexcept {
  Others others;
  for (std::size_t p = 0; p < 3; ++p) {
    others.part[p] = reinterpret_cast<FourBits>(dozen_places[p] != place);
  }
  return others;
}

/// How many parts of a dozen places those in use reach into.
[[gnu::always_inline]] inline std::size_t parts_in_use(unsigned used) noexcept {
  return (static_cast<std::size_t>(std::bit_width(used)) + 3) / 4;
}

/// a at the others, x at the one.
[[gnu::always_inline]] inline Dozen with(const Dozen& a, const Others& others, double x) noexcept {
  Dozen b;
  for (std::size_t p = 0; p < 3; ++p) {
    b.part[p] = others.part[p] != 0 ? a.part[p] : Four{} + x;
  }
  return b;
}

[[gnu::always_inline]] inline void clear_one(Dozen& a, const Others& others) noexcept {
  for (std::size_t p = 0; p < 3; ++p) {
    a.part[p] = reinterpret_cast<Four>(reinterpret_cast<FourBits>(a.part[p]) & others.part[p]);
  }
}

/// factor a
[[gnu::always_inline]] inline Dozen times(double factor, const Dozen& a) noexcept {
  Dozen b;
  for (std::size_t p = 0; p < 3; ++p) b.part[p] = factor * a.part[p];
  return b;
}

/// What a column that enters makes of the table.
struct Image {
  Dozen s;             ///< M u
  Dozen x;             ///< C^T u: its coefficients
  double left = 0.0;   ///< of its square
  double slope = 0.0;  ///< -1/2 df/dm where it has no mass
};

[[gnu::always_inline]] inline void look_at(const Tableau& t, const double* column, double stiffness,
                                           Image& image) noexcept {
  // Two sums each, so that one addition need not wait for the other.
  Dozen u, s, x, odd_s;
  load_ten(column, u);
  for (std::size_t i = 0; i < 10; i += 2) {
    add(s, column[i], t.M[i]);
    add(odd_s, column[i + 1], t.M[i + 1]);
  }
  add(s, 1.0, odd_s);
  const std::size_t parts = parts_in_use(t.used);
  for (std::size_t p = 0; p < parts; ++p) {
    Four even = {}, odd = {};
    for (std::size_t i = 0; i < 10; i += 2) {
      even += column[i] * t.C[i].part[p];
      odd += column[i + 1] * t.C[i + 1].part[p];
    }
    x.part[p] = even + odd;
  }
  image.left = dot(s, u) + stiffness;
  image.slope = dot(t.g, u);
  image.s = s;
  image.x = x;
}

/// The shape looked at becomes passive at this place, which is free.
[[gnu::always_inline]] inline void enter_at(Tableau& t, const Image& image, std::size_t place,
                                            int j, const double* column) noexcept {
  const double inverse = 1.0 / image.left, mass = inverse * image.slope;
  const Others others = others_than(place);
  const Dozen s = image.s, x = with(image.x, others, -1.0);
  t.used |= 1U << place;
  ++t.count;
  t.places = std::max(t.places, place + 1);
  t.shape[place] = j;
  for (std::size_t i = 0; i < 10; ++i) t.U[i][place] = column[i];
  add(t.g, -mass, s);
  t.m = with(t.m, others, 0.0);
  add(t.m, -mass, x);
  const Dozen f = times(-inverse, s), h = times(inverse, x);
  t.diagonal = with(t.diagonal, others, 0.0);
  for (std::size_t p = 0; p < 3; ++p) t.diagonal.part[p] += h.part[p] * x.part[p];
  for (std::size_t i = 0; i < 10; ++i) add(t.M[i], f[i], s);
  t.K[place] = Dozen{};
  const std::size_t parts = parts_in_use(t.used);
  for (std::size_t p = 0; p < parts; ++p) {
    for (std::size_t i = 0; i < 10; ++i) t.C[i].part[p] += f[i] * x.part[p];
    for (std::size_t q = 0; q < t.places; ++q) t.K[q].part[p] += h[q] * x.part[p];
  }
}

/// The coefficients of the shape at this place.
[[gnu::always_inline]] inline Dozen coefficients(const Tableau& t, std::size_t place) noexcept {
  const std::array<Dozen, 10>& C = t.C;
  Dozen c;
  c.part[0] = Four{C[0][place], C[1][place], C[2][place], C[3][place]};
  c.part[1] = Four{C[4][place], C[5][place], C[6][place], C[7][place]};
  c.part[2] = Four{C[8][place], C[9][place], C[8][place], C[9][place]};
  keep_two(c.part[2]);
  return c;
}

/// The largest |g_i| / lengths_i: no slope is larger than this times the shape's bound.
[[gnu::always_inline]] inline double largest_of(const Dozen& g,
                                                const Dozen& inverse_lengths) noexcept {
  Four most = {};
  for (std::size_t p = 0; p < 3; ++p) {
    Four size = g.part[p];
    take_sign(size);
    size *= inverse_lengths.part[p];
    most = size > most ? size : most;
  }
  return std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
}

}  // namespace shapeid::fast::tableau
