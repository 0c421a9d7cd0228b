#include "shapeid/fast/tableau_pivots.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace shapeid::fast::tableau {
namespace {

using Ten = std::array<Dozen, 10>;

/// Prices below this are not followed: rounding of M may be as large. Where none can be larger no
/// shape is priced, and none is called doubtful: that the answer's own slopes are within 1e-10 of
/// these is then all that is asked, and is what is promised of every answer.
constexpr double smallest_price = 1e-13;

[[gnu::always_inline]] inline void take_out(Tableau& t, std::size_t place) noexcept {
  const Dozen c = coefficients(t, place), k = t.K[place];
  const double inverse = 1.0 / t.diagonal[place], mass = t.m[place] * inverse;
  const Others others = others_than(place);
  const Dozen f = times(inverse, c), h = times(-inverse, k);
  add(t.g, mass, c);
  add(t.m, -mass, k);
  t.m = with(t.m, others, 1.0);
  for (std::size_t p = 0; p < 3; ++p) t.diagonal.part[p] += h.part[p] * k.part[p];
  t.diagonal = with(t.diagonal, others, 1.0);
  for (std::size_t i = 0; i < 10; ++i) add(t.M[i], f[i], c);
  const std::size_t parts = parts_in_use(t.used);
  for (std::size_t p = 0; p < parts; ++p) {
    const Four here = k.part[p];
    const FourBits kept = others.part[p];
    for (std::size_t i = 0; i < 10; ++i) {
      Four& entry = t.C[i].part[p];
      entry = reinterpret_cast<Four>(reinterpret_cast<FourBits>(entry - f[i] * here) & kept);
    }
    for (std::size_t q = 0; q < t.places; ++q) {
      Four& entry = t.K[q].part[p];
      entry = reinterpret_cast<Four>(reinterpret_cast<FourBits>(entry + h[q] * here) & kept);
    }
  }
  t.used &= ~(1U << place);
  --t.count;
}

/// Whether a mass is zero or negative.
[[gnu::always_inline]] inline bool some_below(const Tableau& t) noexcept {
  FourBits below = {};
  for (const Four& m : t.m.part) below |= reinterpret_cast<FourBits>(m <= 0.0);
  return ((below[0] | below[1]) | (below[2] | below[3])) != 0;
}

/// The place whose mass, zero or negative, costs most to be held at zero, m^2 over its entry of K;
/// only if there is one. The low bits of each cost carry its place, so that one maximum finds both.
/// Entries of K are positive but for rounding: most_passive where rounding has left no cost that is
/// one, for what stands first then is no place that anything is wrong at.
[[gnu::always_inline]] inline std::size_t furthest_below(const Tableau& t) noexcept {
  Four most = Four{} - 1.0;
  for (std::size_t p = 0; p < 3; ++p) {
    const Four m = t.m.part[p];
    const Four out = m > 0.0 ? Four{} - 1.0 : m * m / t.diagonal.part[p];
    const Four marked =
        reinterpret_cast<Four>((reinterpret_cast<FourBits>(out) & ~place_bits) | dozen_places[p]);
    most = marked > most ? marked : most;
  }
  const double found = std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
  return found > -1.0 ? std::bit_cast<std::uint64_t>(found) & place_bits : most_passive;
}

/// g in single precision, in units that make it prices but for a shape's scale.
struct SingleSlopes {
  float g[12];
};

[[gnu::always_inline]] inline SingleSlopes in_single(const Dozen& g,
                                                     const Problem& problem) noexcept {
  SingleSlopes single;
  for (std::size_t p = 0; p < 3; ++p) {
    using FourFloats = float __attribute__((vector_size(16)));
    const FourFloats four = __builtin_convertvector(problem.inverse_unit * g.part[p], FourFloats);
    for (std::size_t k = 0; k < 4; ++k) single.g[4 * p + k] = four[k];
  }
  return single;
}

/// Sixteen prices.
[[gnu::always_inline]] inline void prices_of(const PriceChunk& chunk, const SingleSlopes& single,
                                             Eight (&prices)[2]) noexcept {
  slopes_of(chunk.U.data(), single.g, prices);
  for (std::ptrdiff_t p = 0; p < 2; ++p) {
    Eight scale, barrier;
    load(chunk.scale.data() + 8 * p, scale);
    load(chunk.barrier.data() + 8 * p, barrier);
    prices[p] = prices[p] * scale - barrier;
  }
}

/// The steepest shape by single precision, and its price.
[[gnu::always_inline]] inline float steepest(const Dozen& g, const Problem& problem,
                                             Lane& lane) noexcept {
  const SingleSlopes single = in_single(g, problem);
  Eight most[2] = {Eight{} - barred, Eight{} - barred};
  EightNumbers number[2] = {lane_numbers[0], lane_numbers[1]};
  for (int c = 0; c < problem.count; ++c) {
    Eight prices[2];
    prices_of(problem.chunks[c], single, prices);
    for (std::ptrdiff_t p = 0; p < 2; ++p) {
      const auto is_more = prices[p] > most[p];
      most[p] = is_more ? prices[p] : most[p];
      number[p] = is_more ? lane_numbers[p] + 16 * c : number[p];
    }
  }
  // The lane's number in the low bits, which single precision cannot vouch for: one maximum finds
  // both.
  Eight marked[2];
  alignas(32) int numbers[16];
  for (std::size_t p = 0; p < 2; ++p) {
    marked[p] = reinterpret_cast<Eight>((reinterpret_cast<EightBits>(most[p]) & ~15U) |
                                        reinterpret_cast<EightBits>(lane_numbers[p]));
    *reinterpret_cast<EightNumbers*>(numbers + 8 * p) = number[p];
  }
  const Eight m = marked[0] > marked[1] ? marked[0] : marked[1];
  const float best = std::max(std::max(std::max(m[0], m[1]), std::max(m[2], m[3])),
                              std::max(std::max(m[4], m[5]), std::max(m[6], m[7])));
  const int found = numbers[std::bit_cast<std::uint32_t>(best) & 15U];
  lane = {problem.chunks + found / 16, static_cast<std::size_t>(found % 16)};
  return best;
}

[[gnu::always_inline]] inline bool enter_shape(Tableau& t, const Problem& problem,
                                               const Lane& lane) noexcept {
  const std::size_t place = free_place(t);
  if (place == most_passive) return false;
  const int j = lane.shape();
  Image image;
  const double* column = problem.U + std::ptrdiff_t{10} * j;
  look_at(t, column, problem.stiffness(j), image);
  const double scale = lane.scale();
  if (!(image.left * scale * scale > problem.smallest_left)) return false;
  enter_at(t, image, place, j, column);
  t.lane[place] = lane;
  t.sizes[place] = problem.largest / scale;
  lane.bar(barred);
  return true;
}

[[gnu::always_inline]] inline void leave_place(Tableau& t, std::size_t place) noexcept {
  take_out(t, place);
  t.lane[place].bar(0.0F);
}

/// What single precision can tell from zero, if no slope makes a larger price than `possible`.
[[gnu::always_inline]] inline double visible(double possible) noexcept {
  return static_cast<double>(uncertain) * possible;
}

/// A bit for each of sixteen prices that is not below; what is no number is not.
[[gnu::always_inline]] inline unsigned not_below(const Eight (&prices)[2], float limit) noexcept {
  constexpr EightBits bits[] = {{1, 2, 4, 8, 16, 32, 64, 128},
                                {256, 512, 1024, 2048, 4096, 8192, 16384, 32768}};
  EightBits found = {};
  for (std::size_t p = 0; p < 2; ++p) {
    found |= ~reinterpret_cast<EightBits>(prices[p] < limit) & bits[p];
  }
  const auto pairs = reinterpret_cast<FourBits>(found);
  const std::uint64_t all = (pairs[0] | pairs[1]) | (pairs[2] | pairs[3]);
  return static_cast<unsigned>(all | all >> 32U);
}

/// M of rows [R c]: four rows of M at a time, from the rows of R that reach them.
template <std::size_t first, std::size_t count>
[[gnu::always_inline]] inline void fill_rows(Tableau& t, const Ten& rows) noexcept {
  Dozen sum[count];
  for (std::size_t i = 0; i < first + count; ++i) {
    for (std::size_t k = 0; k < count; ++k) add(sum[k], rows[i][first + k], rows[i]);
  }
  for (std::size_t k = 0; k < count; ++k) {
    keep_two(sum[k].part[2]);
    t.M[first + k] = sum[k];
  }
}

}  // namespace

SHAPEID_WIDE_AND_MANY void fill(Tableau& t, const Ten& rows, const Dozen& lengths,
                                Dozen& inverse_lengths) noexcept {
  for (std::size_t p = 0; p < 3; ++p) {
    const Four length = lengths.part[p];
    inverse_lengths.part[p] = length > 0.0 ? 1.0 / length : Four{};
    t.m.part[p] = t.diagonal.part[p] = Four{} + 1.0;
  }
  for (Dozen& row : t.C) row = Dozen{};
  keep_two(inverse_lengths.part[2]);
  Dozen g;
  for (const Dozen& row : rows) add(g, row[10], row);
  keep_two(g.part[2]);
  t.g = g;
  t.places = 0;
  t.used = 0;
  t.count = 0;
  fill_rows<0, 4>(t, rows);
  fill_rows<4, 4>(t, rows);
  fill_rows<8, 2>(t, rows);
}

SHAPEID_WIDE_AND_MANY bool enter(Tableau& t, const Problem& problem, const Lane& lane) noexcept {
  return enter_shape(t, problem, lane);
}

SHAPEID_WIDE_AND_MANY void leave(Tableau& t, std::size_t place) noexcept { leave_place(t, place); }

SHAPEID_WIDE_AND_MANY Stop pivot(Tableau& t, const Problem& problem, int most_pivots,
                                 int& pivots) noexcept {
  for (; pivots < most_pivots; ++pivots) {
    if (some_below(t)) {
      const std::size_t place = furthest_below(t);
      if (place == most_passive) return Stop::endless;
      leave_place(t, place);
      continue;
    }
    if (is_full(t, problem)) return Stop::settled;
    const double possible = largest_of(t.g, problem.inverse_lengths) * problem.inverse_length;
    if (!(possible > smallest_price)) return Stop::settled;
    Lane lane;
    const auto price = static_cast<double>(steepest(t.g, problem, lane));
    const double seen = visible(possible);
    if (price < -seen) return Stop::settled;
    const bool is_certain = price > seen && price > smallest_price && price <= 1.0 + seen;
    if (!is_certain || !enter_shape(t, problem, lane)) return Stop::doubtful;
  }
  return Stop::endless;
}

SHAPEID_WIDE_AND_MANY bool find_doubtful(const Dozen& g, const Problem& problem,
                                         Doubtful& doubtful) noexcept {
  const double possible = largest_of(g, problem.inverse_lengths) * problem.inverse_length;
  const auto limit = static_cast<float>(-visible(possible));
  const SingleSlopes single = in_single(g, problem);
  doubtful.count = 0;
  for (int c = 0; c < problem.count; ++c) {
    const PriceChunk& chunk = problem.chunks[c];
    Eight prices[2];
    prices_of(chunk, single, prices);
    for (unsigned left = not_below(prices, limit); left != 0; left &= left - 1) {
      if (doubtful.count == doubtful.shapes.size()) return false;
      doubtful.shapes[doubtful.count++] =
          chunk.shape[static_cast<std::size_t>(std::countr_zero(left))];
    }
  }
  return true;
}

}  // namespace shapeid::fast::tableau
