#include "shapeid/fast/few_table_pivots.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace shapeid::fast::few {
namespace {

using TenRows = std::array<Dozen, 10>;

/// A column of which more than this share of its square is left is judged by what is left.
constexpr double telling_share = 1e-4;

template <std::size_t parts>
struct Pivots : Work<parts> {
  using Work<parts>::add;
  using Work<parts>::set;
  using Work<parts>::largest;

  /// Four rows of A^T A from their diagonal on, and what they are as columns.
  template <std::size_t b>
  [[gnu::always_inline]] static void multiply(const TenRows& A,
                                              std::array<Dozen, most_shapes>& H) noexcept {
    Four sum[parts][4] = {};
    for (const Dozen& a : A) {
      for (std::size_t r = 0; r < 4; ++r) {
        const double factor = a[4 * b + r];
        for (std::size_t p = b; p < parts; ++p) sum[p][r] += factor * a.part[p];
      }
    }
    for (std::size_t p = parts; p < 3; ++p) {
      for (std::size_t r = 0; r < 4; ++r) H[4 * b + r].part[p] = Four{};
    }
    for (std::size_t p = b; p < parts; ++p) {
      for (std::size_t r = 0; r < 4; ++r) H[4 * b + r].part[p] = sum[p][r];
      if (p == b) continue;
      transpose(sum[p]);
      for (std::size_t r = 0; r < 4; ++r) H[4 * p + r].part[b] = sum[p][r];
    }
  }

  [[gnu::always_inline]] static double form(const Problem& problem, Table& now,
                                            Dozen& sizes) noexcept {
    TenRows A;
    Dozen sum, size, squares;
    double square = 0.0;
    for (std::size_t i = 0; i < 10; ++i) {
      const Dozen& r = problem.link.rows()[i];
      Dozen row;
      for (std::size_t l = i; l < 10; ++l) add(row, r[l], problem.U[l]);
      const double c = r[10];
      add(sum, c, row);
      square += c * c;
      for (std::size_t p = 0; p < parts; ++p) squares.part[p] += row.part[p] * row.part[p];
      A[i] = row;
      Dozen u = problem.U[i];
      for (Four& part : u.part) take_sign(part);
      add(size, problem.link.lengths()[i], u);
    }
    now.x = sum;
    now.squares = squares;
    sizes = size;
    multiply<0>(A, now.H);
    if constexpr (parts > 1) multiply<1>(A, now.H);
    if constexpr (parts > 2) multiply<2>(A, now.H);
    for (std::size_t p = 0; p < 3; ++p) now.side.part[p] = Four{} + 1.0;
    now.passive = 0;
    return square;
  }

  [[gnu::always_inline]] static void stiffen(Table& now, const Dozen& stiffness,
                                             std::size_t shapes) noexcept {
    for (std::size_t k = 0; k < shapes; ++k) set(now.H[k], k, now.H[k][k] + stiffness[k]);
    for (std::size_t p = 0; p < parts; ++p) now.squares.part[p] += stiffness.part[p];
  }

  /// What is out of place by most, and what is gained by its exchange: of a passive shape with
  /// negative mass m m^2 / K, of another with positive slope s s^2 / d, with d what is left of its
  /// square; or s^2 over all of it where hardly anything is left, which a small s then makes too
  /// much of. The low bits of each carry its number, so that one maximum finds both.
  /// `least`: what is much of each square; `weight`: of a slope's square where there is less.
  [[gnu::always_inline]] static double furthest_out(const Front<parts>& front,
                                                    const Four (&least)[parts],
                                                    const Four (&weight)[parts],
                                                    const Dozen& inverse) noexcept {
    Four marked[parts];
    for (std::size_t p = 0; p < parts; ++p) {
      const Four x = front.x[p];
      Four size = x;
      take_sign(size);
      const auto has_much_left = front.diagonal[p] > least[p];
      const Four gain = has_much_left ? inverse.part[p] : weight[p];
      const Four out = (front.side[p] < 0.0 ? -inverse.part[p] : gain) * (x * size);
      marked[p] =
          reinterpret_cast<Four>((reinterpret_cast<FourBits>(out) & ~place_bits) | dozen_places[p]);
    }
    return largest(marked);
  }

  [[gnu::always_inline]] static bool pivot(Table& now, std::size_t shapes, double smallest,
                                           int most_pivots) noexcept {
    Front<parts> front(now);
    Four least[parts], weight[parts];
    for (std::size_t p = 0; p < parts; ++p) {
      const Four square = now.squares.part[p];
      least[p] = telling_share * square;
      weight[p] = square > 0.0 ? 1.0 / square : Four{};
    }
    while (true) {
      Dozen inverse;
      for (std::size_t p = 0; p < parts; ++p) inverse.part[p] = 1.0 / front.diagonal[p];
      const double most = furthest_out(front, least, weight, inverse);
      if (!(most > smallest)) return true;
      if (now.pivots >= most_pivots) return false;
      const std::size_t k = std::bit_cast<std::uint64_t>(most) & place_bits;
      const bool enters = now.side[k] > 0.0;
      const bool depends = !(now.diagonal[k] > smallest_share * now.squares[k]);
      // One question, since which way it goes cannot be foreseen.
      if (static_cast<int>(enters) & static_cast<int>(depends)) {
        for (std::size_t p = 0; p < parts; ++p) {
          weight[p] = dozen_places[p] == k ? Four{} : weight[p];
        }
        ++now.pivots;  // it depends on the passive ones; that is a turn, too
      } else {
        exchange(now, front, shapes, k, inverse[k]);
      }
    }
  }

  [[gnu::always_inline]] static void enter(Table& now, std::size_t shapes,
                                           std::span<const int> passive) noexcept {
    for (std::size_t p = 0; p < 3; ++p) {
      const Four square = now.squares.part[p];
      now.diagonal.part[p] = square > 0.0 ? square : Four{} + 1.0;
    }
    Front<parts> front(now);
    for (const int j : passive) {
      const auto k = static_cast<std::size_t>(j);
      if (now.squares[k] > 0.0 && now.diagonal[k] > smallest_share * now.squares[k]) {
        exchange(now, front, shapes, k, 1.0 / now.diagonal[k]);
      }
    }
  }

  [[gnu::always_inline]] static double furthest_above(const Table& now, const Problem& problem,
                                                      const Dozen& slopes, const Dozen& sizes,
                                                      double threshold) noexcept {
    Dozen slope, odd;
    for (std::size_t i = 0; i < 10; i += 2) {
      add(slope, slopes[i], problem.U[i]);
      add(odd, slopes[i + 1], problem.U[i + 1]);
    }
    constexpr double lowest = -std::numeric_limits<double>::max();
    Four above[parts];
    for (std::size_t p = 0; p < parts; ++p) {
      const auto asked = now.side.part[p] > 0.0 && dozen_places[p] < problem.shapes;
      above[p] = asked ? slope.part[p] + odd.part[p] - threshold * sizes.part[p] : Four{} + lowest;
    }
    return largest(above);
  }
};

}  // namespace

SHAPEID_WIDE_AND_MANY double form(const Problem& problem, Table& now, Dozen& sizes) noexcept {
  return by_parts(
      problem.shapes, [&](auto parts) __attribute__((always_inline)) {
        return Pivots<decltype(parts)::value>::form(problem, now, sizes);
      });
}

SHAPEID_WIDE void stiffen(Table& now, const Dozen& stiffness, std::size_t shapes) noexcept {
  Pivots<3>::stiffen(now, stiffness, shapes);
}

SHAPEID_WIDE_AND_MANY void enter(Table& now, std::size_t shapes,
                                 std::span<const int> passive) noexcept {
  by_parts(
      shapes, [&](auto parts) __attribute__((always_inline)) {
        Pivots<decltype(parts)::value>::enter(now, shapes, passive);
      });
}

SHAPEID_WIDE void leave(Table& now, std::size_t shapes, unsigned leaving) noexcept {
  for (; leaving != 0; leaving &= leaving - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(leaving));
    exchange<3>(now, shapes, k, 1.0 / now.diagonal[k]);
  }
}

SHAPEID_WIDE_AND_MANY bool pivot(Table& now, std::size_t shapes, double smallest,
                                 int most_pivots) noexcept {
  return by_parts(
      shapes, [&](auto parts) __attribute__((always_inline)) {
        return Pivots<decltype(parts)::value>::pivot(now, shapes, smallest, most_pivots);
      });
}

SHAPEID_WIDE_AND_MANY double furthest_above(const Table& now, const Problem& problem,
                                            const Dozen& slopes, const Dozen& sizes,
                                            double threshold) noexcept {
  return by_parts(
      problem.shapes, [&](auto parts) __attribute__((always_inline)) {
        return Pivots<decltype(parts)::value>::furthest_above(now, problem, slopes, sizes,
                                                              threshold);
      });
}

}  // namespace shapeid::fast::few
