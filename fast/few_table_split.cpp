#include "shapeid/fast/few_table_split.hpp"

#include <bit>
#include <cstddef>

#include "shapeid/fast/wide.hpp"

namespace shapeid::fast::few {
namespace {

template <std::size_t parts>
struct Division : Work<parts> {
  using Work<parts>::add;
  using Work<parts>::set;
  using Work<parts>::dot;

  /// What a column has in common with the others.
  struct Products {
    Dozen columns;  ///< A^T a
    double square;  ///< || a ||^2, which is never negative
    double forces;  ///< c^T a
  };

  /// Of column `k` of A. Two sums each, so that one addition need not wait for the other.
  [[gnu::always_inline]] static Products products_with(const Problem& problem,
                                                       std::size_t k) noexcept {
    Dozen a, s, h, odd_a, odd_s, odd_h;
    for (std::size_t i = 0; i < 10; i += 2) {
      fast::add(a, problem.U[i][k], problem.link.columns()[i]);
      fast::add(odd_a, problem.U[i + 1][k], problem.link.columns()[i + 1]);
    }
    fast::add(a, 1.0, odd_a);
    for (std::size_t i = 0; i < 10; i += 2) {
      fast::add(s, a[i], problem.link.rows()[i]);
      fast::add(odd_s, a[i + 1], problem.link.rows()[i + 1]);
    }
    fast::add(s, 1.0, odd_s);
    for (std::size_t i = 0; i < 10; i += 2) {
      add(h, s[i], problem.U[i]);
      add(odd_h, s[i + 1], problem.U[i + 1]);
    }
    add(h, 1.0, odd_h);
    return {h, fast::dot(a, a), s[10]};
  }

  /// What a column that is not passive has in the table.
  struct Image {
    Dozen row;
    double left, slope;  ///< of its square, and of the objective
  };

  /// From its products with the columns (those of passive shapes count), with the stiffness in its
  /// `square`, and with the forces.
  [[gnu::always_inline]] static Image image_of(const Table& now, const Dozen& products,
                                               double square, double forces) noexcept {
    Dozen inside, row;
    for (std::size_t p = 0; p < parts; ++p) {
      inside.part[p] = now.side.part[p] < 0.0 ? products.part[p] : Four{};
    }
    for (unsigned left = now.passive; left != 0; left &= left - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(left));
      add(row, inside[i], now.H[i]);
    }
    const double left = square - dot(inside, row), slope = forces - dot(inside, now.x);
    for (std::size_t p = 0; p < parts; ++p) {
      row.part[p] = products.part[p] - inside.part[p] - row.part[p];
    }
    return {row, left, slope};
  }

  /// Place k has another column, and is not passive.
  [[gnu::always_inline]] static void appear(Table& now, const Problem& problem, std::size_t k,
                                            double stiffness) noexcept {
    const Products with = products_with(problem, k);
    const double square = with.square + stiffness;
    Image image = image_of(now, with.columns, square, with.forces);
    for (std::size_t i = 0; i < problem.shapes; ++i) set(now.H[i], k, now.side[i] * image.row[i]);
    set(image.row, k, image.left);
    now.H[k] = image.row;
    set(now.diagonal, k, image.left);
    set(now.x, k, image.slope);
    set(now.squares, k, square);
  }

  /// Neither part is passive, and pivots may choose.
  [[gnu::always_inline]] static void start_without(Table& now, const Problem& problem,
                                                   const Cut& cut) noexcept {
    if (now.side[cut.whole] < 0.0) {
      exchange<parts>(now, cut.part, cut.whole, 1.0 / now.diagonal[cut.whole]);
    }
    appear(now, problem, cut.whole, cut.remaining);
    appear(now, problem, cut.part, cut.leaving);
  }

  [[gnu::always_inline]] static void split(Table& now, const Problem& problem,
                                           const Cut& cut) noexcept {
    if (!(now.side[cut.whole] < 0.0)) return start_without(now, problem, cut);
    Products with = products_with(problem, cut.part);
    const double square = with.square + cut.leaving, both = with.columns[cut.whole];
    // || a ||^2 = || s_1 a_1 + s_2 a_2 ||^2, each with its stiffness, solved for that of a_1: to as
    // many digits as a measure needs.
    const double remaining =
        (now.squares[cut.whole] - cut.goes * (2.0 * cut.remains * both + cut.goes * square)) /
        (cut.remains * cut.remains);
    set(with.columns, cut.whole, cut.remains * both + cut.goes * with.square + cut.shared);
    Image image = image_of(now, with.columns, square, with.forces);
    if (!(image.left > smallest_share * square && remaining > 0.0)) {
      return start_without(now, problem, cut);
    }
    set(image.row, cut.part, image.left);
    now.H[cut.part] = image.row;
    set(now.diagonal, cut.part, image.left);
    set(now.x, cut.part, image.slope);
    set(now.squares, cut.part, square);
    set(now.squares, cut.whole, remaining);
    exchange<parts>(now, problem.shapes, cut.part, 1.0 / image.left);
    add(now.H[cut.part], cut.goes, now.H[cut.whole]);
    for (Four& part : now.H[cut.whole].part) part *= cut.remains;
    Dozen remain, go;
    for (std::size_t p = 0; p < parts; ++p) remain.part[p] += 1.0;
    set(remain, cut.whole, cut.remains);
    set(go, cut.part, cut.goes);
    const auto turn = [&](Dozen& entries) {
      const double whole = entries[cut.whole];
      for (std::size_t p = 0; p < parts; ++p) {
        entries.part[p] = remain.part[p] * entries.part[p] + whole * go.part[p];
      }
    };
    for (std::size_t i = 0; i < problem.shapes; ++i) turn(now.H[i]);
    turn(now.x);
    set(now.diagonal, cut.whole, now.H[cut.whole][cut.whole]);
    set(now.diagonal, cut.part, now.H[cut.part][cut.part]);
  }
};

}  // namespace

SHAPEID_WIDE void split(Table& now, const Problem& problem, const Cut& cut) noexcept {
  by_parts(
      problem.shapes, [&](auto parts) __attribute__((always_inline)) {
        Division<decltype(parts)::value>::split(now, problem, cut);
      });
}

}  // namespace shapeid::fast::few
