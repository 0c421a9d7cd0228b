#include "shapeid/fast/few_shapes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {
namespace {

constexpr std::size_t dozen = FewShapes::most_shapes;
using Exchanged = FewShapes::Exchanged;
using TenRows = std::array<Dozen, 10>;

/// A gain below the square of this share of || c || is rounding of H.
constexpr double smallest_step = 1e-13;

/// A column of which less than this share of its square is new counts as dependent: rounding of H
/// may be a hundredth of it.
constexpr double smallest_share = 1e-12;

/// A column of which more than this share of its square is left is judged by what is left.
constexpr double telling_share = 1e-4;

/// The problem's data.
struct Data {
  const TenRows& U;  ///< a shape a lane
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

  /// Four rows of A^T A from their diagonal on, and what they are as columns.
  template <std::size_t b>
  [[gnu::always_inline]] static void multiply(const TenRows& A,
                                              std::array<Dozen, dozen>& H) noexcept {
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

  /// H = A^T A and q = A^T c with A = R U, nothing exchanged, and what bounds the columns of A.
  /// Returns the square of || c ||.
  [[gnu::always_inline]] static double form(const Data& data, Exchanged& now,
                                            Dozen& sizes) noexcept {
    TenRows A;
    Dozen sum, size, squares;
    double square = 0.0;
    for (std::size_t i = 0; i < 10; ++i) {
      const Dozen& r = data.link.rows()[i];
      Dozen row;
      for (std::size_t l = i; l < 10; ++l) add(row, r[l], data.U[l]);
      const double c = r[10];
      add(sum, c, row);
      square += c * c;
      for (std::size_t p = 0; p < parts; ++p) squares.part[p] += row.part[p] * row.part[p];
      A[i] = row;
      Dozen u = data.U[i];
      for (Four& part : u.part) take_sign(part);
      add(size, data.link.lengths()[i], u);
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

  /// The density term's part of H.
  [[gnu::always_inline]] static void stiffen(Exchanged& now, const Dozen& stiffness,
                                             std::size_t shapes) noexcept {
    for (std::size_t k = 0; k < shapes; ++k) set(now.H[k], k, now.H[k][k] + stiffness[k]);
    for (std::size_t p = 0; p < parts; ++p) now.squares.part[p] += stiffness.part[p];
  }

  /// What is out of place by most, and what is gained by its exchange: of a passive shape with
  /// negative mass m m^2 / K, of another with positive slope s s^2 / d, with d what is left of its
  /// square; or s^2 over all of it where hardly anything is left, which a small s then makes too
  /// much of. The low bits of each carry its number, so that one maximum finds both.
  [[gnu::always_inline]] static double furthest_out(const Exchanged& now,
                                                    const Dozen& inverse) noexcept {
    Four marked[parts];
    for (std::size_t p = 0; p < parts; ++p) {
      const Four x = now.x.part[p];
      Four size = x;
      take_sign(size);
      const auto has_much_left = now.diagonal.part[p] > telling_share * now.squares.part[p];
      const Four gain = has_much_left ? inverse.part[p] : now.weight.part[p];
      const Four out = (now.side.part[p] < 0.0 ? -inverse.part[p] : gain) * x * size;
      marked[p] =
          reinterpret_cast<Four>((reinterpret_cast<FourBits>(out) & ~place_bits) | dozen_places[p]);
    }
    return std::max(largest(marked), 0.0);
  }

  /// The exchange of x_k and its slope in  slope = q - H x,  for either direction. Column k is row
  /// k but for the signs of the rows on the other side. Entries k are set among their neighbours:
  /// what is written in part is slow to read as a whole.
  [[gnu::always_inline]] static void exchange(Exchanged& now, std::size_t shapes, std::size_t k,
                                              double inverse) noexcept {
    Dozen row = now.H[k], column;
    FourBits others[parts];
    const double step = inverse * now.x[k], same = now.side[k];
    for (std::size_t p = 0; p < parts; ++p) {
      const auto is_k = dozen_places[p] == k;
      others[p] = reinterpret_cast<FourBits>(~is_k);
      Four &side = now.side.part[p], &x = now.x.part[p], &diagonal = now.diagonal.part[p];
      column.part[p] = same * side * row.part[p];
      row.part[p] = is_k ? Four{} + inverse : inverse * row.part[p];
      x = is_k ? Four{} + step : x - step * column.part[p];
      diagonal = is_k ? Four{} + inverse : diagonal - column.part[p] * row.part[p];
      side = is_k ? -side : side;
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

  /// Pivots until nothing is out of place by more than `smallest`; false if `most_pivots` were too
  /// few.
  [[gnu::always_inline]] static bool pivot(Exchanged& now, std::size_t shapes, double smallest,
                                           int most_pivots) noexcept {
    for (std::size_t p = 0; p < parts; ++p) {
      const Four square = now.squares.part[p];
      now.weight.part[p] = square > 0.0 ? 1.0 / square : Four{};
    }
    while (true) {
      Dozen inverse;
      for (std::size_t p = 0; p < parts; ++p) inverse.part[p] = 1.0 / now.diagonal.part[p];
      const double most = furthest_out(now, inverse);
      if (!(most > smallest)) return true;
      if (now.pivots >= most_pivots) return false;
      const std::size_t k = std::bit_cast<std::uint64_t>(most) & place_bits;
      if (now.side[k] > 0.0 && !(now.diagonal[k] > smallest_share * now.squares[k])) {
        set(now.weight, k, 0.0);  // it depends on the passive ones; that is a turn, too
        ++now.pivots;
      } else {
        exchange(now, shapes, k, inverse[k]);
      }
    }
  }

  /// The passive shapes, as far as their columns do not depend on those before.
  [[gnu::always_inline]] static void enter(Exchanged& now, std::size_t shapes,
                                           std::span<const int> passive) noexcept {
    for (std::size_t p = 0; p < 3; ++p) {
      const Four square = now.squares.part[p];
      now.diagonal.part[p] = square > 0.0 ? square : Four{} + 1.0;
    }
    for (const int j : passive) {
      const auto k = static_cast<std::size_t>(j);
      if (now.squares[k] > 0.0 && now.diagonal[k] > smallest_share * now.squares[k]) {
        exchange(now, shapes, k, 1.0 / now.diagonal[k]);
      }
    }
  }

  /// What a column has in common with the others.
  struct Products {
    Dozen columns;  ///< A^T a
    double square;  ///< || a ||^2, which is never negative
    double forces;  ///< c^T a
  };

  /// Of column `k` of A. Two sums each, so that one addition need not wait for the other.
  [[gnu::always_inline]] static Products products_with(const Data& data, std::size_t k) noexcept {
    Dozen a, s, h, odd_a, odd_s, odd_h;
    for (std::size_t i = 0; i < 10; i += 2) {
      fast::add(a, data.U[i][k], data.link.columns()[i]);
      fast::add(odd_a, data.U[i + 1][k], data.link.columns()[i + 1]);
    }
    fast::add(a, 1.0, odd_a);
    for (std::size_t i = 0; i < 10; i += 2) {
      fast::add(s, a[i], data.link.rows()[i]);
      fast::add(odd_s, a[i + 1], data.link.rows()[i + 1]);
    }
    fast::add(s, 1.0, odd_s);
    for (std::size_t i = 0; i < 10; i += 2) {
      add(h, s[i], data.U[i]);
      add(odd_h, s[i + 1], data.U[i + 1]);
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
  [[gnu::always_inline]] static Image image_of(const Exchanged& now, const Dozen& products,
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
  [[gnu::always_inline]] static void appear(Exchanged& now, const Data& data, std::size_t k,
                                            double stiffness) noexcept {
    const Products with = products_with(data, k);
    const double square = with.square + stiffness;
    Image image = image_of(now, with.columns, square, with.forces);
    for (std::size_t i = 0; i < data.shapes; ++i) set(now.H[i], k, now.side[i] * image.row[i]);
    set(image.row, k, image.left);
    now.H[k] = image.row;
    set(now.diagonal, k, image.left);
    set(now.x, k, image.slope);
    set(now.squares, k, square);
  }

  using Cut = FewShapes::Cut;

  /// Neither part is passive, and pivots may choose.
  [[gnu::always_inline]] static void start_without(Exchanged& now, const Data& data,
                                                   const Cut& cut) noexcept {
    if (now.side[cut.whole] < 0.0) {
      exchange(now, cut.part, cut.whole, 1.0 / now.diagonal[cut.whole]);
    }
    appear(now, data, cut.whole, cut.remaining);
    appear(now, data, cut.part, cut.leaving);
  }

  /// The whole's column is the sum of the parts' columns, those of U, each times its size. So the
  /// new part becomes passive beside the whole, and then masses go over: unless the whole is not
  /// passive, or the part depends on what is.
  [[gnu::always_inline]] static void split(Exchanged& now, const Data& data,
                                           const Cut& cut) noexcept {
    if (!(now.side[cut.whole] < 0.0)) return start_without(now, data, cut);
    Products with = products_with(data, cut.part);
    const double square = with.square + cut.leaving, both = with.columns[cut.whole];
    // || a ||^2 = || s_1 a_1 + s_2 a_2 ||^2, each with its stiffness, solved for that of a_1: to as
    // many digits as a measure needs.
    const double remaining =
        (now.squares[cut.whole] - cut.goes * (2.0 * cut.remains * both + cut.goes * square)) /
        (cut.remains * cut.remains);
    set(with.columns, cut.whole, cut.remains * both + cut.goes * with.square + cut.shared);
    Image image = image_of(now, with.columns, square, with.forces);
    if (!(image.left > smallest_share * square && remaining > 0.0)) {
      return start_without(now, data, cut);
    }
    set(image.row, cut.part, image.left);
    now.H[cut.part] = image.row;
    set(now.diagonal, cut.part, image.left);
    set(now.x, cut.part, image.slope);
    set(now.squares, cut.part, square);
    set(now.squares, cut.whole, remaining);
    exchange(now, data.shapes, cut.part, 1.0 / image.left);
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
    for (std::size_t i = 0; i < data.shapes; ++i) turn(now.H[i]);
    turn(now.x);
    set(now.diagonal, cut.whole, now.H[cut.whole][cut.whole]);
    set(now.diagonal, cut.part, now.H[cut.part][cut.part]);
  }

  /// Of the shapes that are not passive: the largest of slope - threshold x size.
  [[gnu::always_inline]] static double furthest_above(const Exchanged& now, const Data& data,
                                                      const Dozen& slopes, const Dozen& sizes,
                                                      double threshold) noexcept {
    Dozen slope, odd;
    for (std::size_t i = 0; i < 10; i += 2) {
      add(slope, slopes[i], data.U[i]);
      add(odd, slopes[i + 1], data.U[i + 1]);
    }
    constexpr double lowest = -std::numeric_limits<double>::max();
    Four above[parts];
    for (std::size_t p = 0; p < parts; ++p) {
      const auto asked = now.side.part[p] > 0.0 && dozen_places[p] < data.shapes;
      above[p] = asked ? slope.part[p] + odd.part[p] - threshold * sizes.part[p] : Four{} + lowest;
    }
    return largest(above);
  }
};

/// use(Work) with as many parts as the shapes need.
template <typename Use>
[[gnu::always_inline]] inline auto by_parts(std::size_t shapes, Use use) noexcept {
  if (shapes <= 4) return use(Work<1>());
  if (shapes <= 8) return use(Work<2>());
  return use(Work<3>());
}

SHAPEID_WIDE double form(const Data& data, Exchanged& now, Dozen& sizes) noexcept {
  return by_parts(
      data.shapes, [&](auto work) __attribute__((always_inline)) {
        return decltype(work)::form(data, now, sizes);
      });
}

SHAPEID_WIDE void stiffen(Exchanged& now, const Dozen& stiffness, std::size_t shapes) noexcept {
  Work<3>::stiffen(now, stiffness, shapes);
}

SHAPEID_WIDE void enter(Exchanged& now, std::size_t shapes, std::span<const int> passive) noexcept {
  by_parts(
      shapes, [&](auto work)
                  __attribute__((always_inline)) { decltype(work)::enter(now, shapes, passive); });
}

SHAPEID_WIDE bool pivot(Exchanged& now, std::size_t shapes, double smallest,
                        int most_pivots) noexcept {
  return by_parts(
      shapes, [&](auto work) __attribute__((always_inline)) {
        return decltype(work)::pivot(now, shapes, smallest, most_pivots);
      });
}

SHAPEID_WIDE void split(Exchanged& now, const Data& data, const FewShapes::Cut& cut) noexcept {
  by_parts(
      data.shapes, [&](auto work)
                       __attribute__((always_inline)) { decltype(work)::split(now, data, cut); });
}

SHAPEID_WIDE double furthest_above(const Exchanged& now, const Data& data, const Dozen& slopes,
                                   const Dozen& sizes, double threshold) noexcept {
  return by_parts(
      data.shapes, [&](auto work) __attribute__((always_inline)) {
        return decltype(work)::furthest_above(now, data, slopes, sizes, threshold);
      });
}

}  // namespace

void FewShapes::clear() noexcept {
  shapes_ = 0;
  U_.fill(Dozen{});
}

void FewShapes::put(int j, const ShapeColumns::Column& u) noexcept {
  shapes_ = std::max(shapes_, j + 1);
  if (!fits()) return;
  for (int i = 0; i < 10; ++i) U_[place(i)][place(j)] = u[i];
}

bool FewShapes::start(const LinkRows& rows, double lambda,
                      const std::vector<int>& passive) noexcept {
  if (!fits()) return false;
  const std::size_t shapes = place(shapes_);
  rows_ = &rows;
  lambda_ = lambda;
  const double square = form({U_, rows, shapes}, now_, sizes_);
  if (lambda > 0.0) {
    Dozen stiffness;
    for (std::size_t j = 0; j < shapes; ++j) {
      stiffness[j] = lambda / (*V_)[static_cast<Eigen::Index>(j)];
    }
    stiffen(now_, stiffness, shapes);
  }
  // Without forces there is no mass.
  enter(now_, shapes, square > 0.0 ? std::span(passive) : std::span<const int>());
  now_.pivots = 0;
  // What is not out of place at all still carries a number in its low bits: hence the minimum.
  smallest_ = std::max(smallest_step * smallest_step * square, std::numeric_limits<double>::min());
  return true;
}

bool FewShapes::divide(int j, int other, double V1, double V2) noexcept {
  const double V = V1 + V2;
  split(now_, {U_, *rows_, place(shapes_)},
        {.whole = place(j),
         .part = place(other),
         .remains = V1 / V,
         .goes = V2 / V,
         .shared = lambda_ / V,
         .remaining = lambda_ / V1,
         .leaving = lambda_ / V2});
  for (const int part : {j, other}) {
    double even = 0.0, odd = 0.0;
    for (std::size_t i = 0; i < 10; i += 2) {
      even += std::abs(U_[i][place(part)]) * rows_->lengths()[i];
      odd += std::abs(U_[i + 1][place(part)]) * rows_->lengths()[i + 1];
    }
    sizes_[place(part)] = even + odd;
  }
  now_.pivots = 0;
  return true;
}

bool FewShapes::settle() noexcept {
  return fits() && pivot(now_, place(shapes_), smallest_, 4 * shapes_);
}

AtPlaces FewShapes::answer() const noexcept {
  static constexpr std::array<int, dozen> numbers = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  return {&U_, now_.H.data(), numbers.data(), &now_.x, &sizes_, now_.passive};
}

bool FewShapes::none_enters(const Dozen& slopes, double threshold) noexcept {
  return furthest_above(now_, {U_, *rows_, place(shapes_)}, slopes, sizes_,
                        threshold * rows_->length()) <= 0.0;
}

void FewShapes::correct(const Dozen& masses, const Dozen&) noexcept {
  now_.pivots = 0;
  for (unsigned left = now_.passive; left != 0; left &= left - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(left));
    now_.x[k] = masses[k];
  }
}

void FewShapes::solve_normal(Eigen::VectorXd& x) noexcept {
  Dozen right;
  Eigen::Index entry = 0;
  for (int j = 0; j < shapes_; ++j) {
    if (is_passive(j)) right[place(j)] = x[entry++];
  }
  entry = 0;
  for (int i = 0; i < shapes_; ++i) {
    if (is_passive(i)) x[entry++] = dot(now_.H[place(i)], right);
  }
}

}  // namespace shapeid::fast
