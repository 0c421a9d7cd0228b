#include "shapeid/fast/few_shapes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

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

/// H = A^T A and q = A^T c with A = R U, the square of || c ||, and what bounds the columns of A.
SHAPEID_WIDE double form(const TenRows& U, const LinkRows& link, std::size_t shapes,
                         std::array<Dozen, dozen>& H, Dozen& q, Dozen& sizes) noexcept {
  TenRows A;
  Dozen sum, size;
  double square = 0.0;
  for (std::size_t i = 0; i < 10; ++i) {
    const Dozen& r = link.rows()[i];
    Dozen row;
    for (std::size_t l = i; l < 10; ++l) add(row, r[l], U[l]);
    const double c = r[10];
    add(sum, c, row);
    square += c * c;
    A[i] = row;
    Dozen u = U[i];
    for (Four& part : u.part) take_sign(part);
    add(size, link.lengths()[i], u);
  }
  q = sum;
  sizes = size;
  for (std::size_t k = 0; k < shapes; ++k) {
    Dozen row;
    for (const Dozen& a : A) add(row, a[k], a);
    H[k] = row;
  }
  return square;
}

/// What is out of place by most, and by how much: a passive shape of negative mass m by m^2 h,
/// another of positive slope s by s^2 / h, with h the square of its column. (What is left of the
/// column is the better measure, but would have to be divided by first.) The low bits of each carry
/// its number, so that one maximum finds both.
[[gnu::always_inline]] inline double furthest_out(const Exchanged& now) noexcept {
  Four most = {};
  for (std::size_t p = 0; p < 3; ++p) {
    const Four x = now.x.part[p];
    Four size = x;
    take_sign(size);
    const Four out = now.weight.part[p] * x * size;
    const Four marked =
        reinterpret_cast<Four>((reinterpret_cast<FourBits>(out) & ~place_bits) | dozen_places[p]);
    most = marked > most ? marked : most;
  }
  return std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
}

/// The inverses of the diagonal, before it is known which of them is needed: nothing waits for
/// them.
[[gnu::always_inline]] inline void invert(const Exchanged& now, Dozen& inverse) noexcept {
  for (std::size_t p = 0; p < 3; ++p) inverse.part[p] = 1.0 / now.diagonal.part[p];
}

/// The exchange of x_k and its slope in  slope = q - H x,  for either direction. Column k is row k
/// but for the signs of the rows on the other side. Entries k are set among their neighbours: what
/// is written in part is slow to read as a whole.
[[gnu::always_inline]] inline void exchange(Exchanged& now, std::size_t shapes, std::size_t k,
                                            double inverse) noexcept {
  Dozen row = now.H[k], column;
  FourBits others[3];
  const double step = inverse * now.x[k], same = now.side[k];
  for (std::size_t p = 0; p < 3; ++p) {
    const auto is_k = dozen_places[p] == k;
    others[p] = reinterpret_cast<FourBits>(~is_k);
    Four &side = now.side.part[p], &x = now.x.part[p], &diagonal = now.diagonal.part[p];
    Four &weight = now.weight.part[p], &other = now.other_weight.part[p];
    column.part[p] = same * side * row.part[p];
    row.part[p] = is_k ? Four{} + inverse : inverse * row.part[p];
    x = is_k ? Four{} + step : x - step * column.part[p];
    diagonal = is_k ? Four{} + inverse : diagonal - column.part[p] * row.part[p];
    side = is_k ? -side : side;
    const Four before = weight;
    weight = is_k ? other : weight;
    other = is_k ? before : other;
  }
  for (std::size_t i = 0; i < shapes; ++i) {
    for (std::size_t p = 0; p < 3; ++p) {
      Four& entry = now.H[i].part[p];
      entry = reinterpret_cast<Four>(reinterpret_cast<FourBits>(entry) & others[p]);
      entry -= column[i] * row.part[p];
    }
  }
  now.H[k] = row;
  ++now.pivots;
}

/// Pivots until nothing is out of place by more than `smallest`; false if `most_pivots` were too
/// few. `squares`: the diagonal of H.
SHAPEID_WIDE bool settle(Exchanged& now, const Dozen& squares, std::size_t shapes, double smallest,
                         int most_pivots) noexcept {
  while (true) {
    Dozen inverse;
    invert(now, inverse);
    const double most = furthest_out(now);
    if (!(most > smallest)) return true;
    const std::size_t k = std::bit_cast<std::uint64_t>(most) & place_bits;
    if (now.side[k] > 0.0 && !(now.diagonal[k] > smallest_share * squares[k])) {
      now.weight[k] = 0.0;  // it depends on the passive ones
    } else if (now.pivots == most_pivots) {
      return false;
    } else {
      exchange(now, shapes, k, inverse[k]);
    }
  }
}

/// The passive shapes, as far as their columns do not depend on those before.
SHAPEID_WIDE void start(Exchanged& now, const Dozen& squares, std::size_t shapes,
                        const std::vector<int>& passive) noexcept {
  for (const int j : passive) {
    const auto k = static_cast<std::size_t>(j);
    if (squares[k] > 0.0 && now.diagonal[k] > smallest_share * squares[k]) {
      exchange(now, shapes, k, 1.0 / now.diagonal[k]);
    }
  }
}

/// Of the shapes with side 1: the largest of slope - threshold x size.
SHAPEID_WIDE double furthest_above(const TenRows& U, const Dozen& side, const Dozen& slopes,
                                   const Dozen& sizes, double threshold,
                                   std::size_t shapes) noexcept {
  Dozen slope;
  for (std::size_t i = 0; i < 10; ++i) add(slope, slopes[i], U[i]);
  constexpr double lowest = -std::numeric_limits<double>::max();
  Four most = Four{} + lowest;
  for (std::size_t p = 0; p < 3; ++p) {
    const Four above = slope.part[p] - threshold * sizes.part[p];
    const auto asked = side.part[p] > 0.0 && dozen_places[p] < shapes;
    const Four here = asked ? above : Four{} + lowest;
    most = here > most ? here : most;
  }
  return std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
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

bool FewShapes::guess(const Eigen::VectorXd& V, double lambda, const LinkRows& rows,
                      const std::vector<int>& passive) noexcept {
  const std::size_t shapes = place(shapes_);
  const double square = form(U_, rows, shapes, now_.H, now_.x, sizes_);
  Dozen squares;
  for (std::size_t j = 0; j < dozen; ++j) {
    if (lambda > 0.0 && j < shapes) now_.H[j][j] += lambda / V[static_cast<Eigen::Index>(j)];
    squares[j] = j < shapes ? now_.H[j][j] : 0.0;
    now_.diagonal[j] = squares[j] > 0.0 ? squares[j] : 1.0;
    now_.weight[j] = squares[j] > 0.0 ? 1.0 / squares[j] : 0.0;
    now_.other_weight[j] = -squares[j];
  }
  for (Four& side : now_.side.part) side = Four{1.0, 1.0, 1.0, 1.0};
  if (square > 0.0) start(now_, squares, shapes, passive);  // without forces there is no mass
  now_.pivots = 0;
  // What is not out of place at all still carries a number in its low bits: hence the minimum.
  const double smallest =
      std::max(smallest_step * smallest_step * square, std::numeric_limits<double>::min());
  return settle(now_, squares, shapes, smallest, 4 * shapes_);
}

AtPlaces FewShapes::answer() const noexcept {
  static constexpr std::array<int, dozen> numbers = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  unsigned used = 0;
  for (std::size_t j = 0; j < place(shapes_); ++j) {
    used |= static_cast<unsigned>(std::signbit(now_.side[j])) << j;
  }
  return {&U_, now_.H.data(), numbers.data(), &now_.x, &sizes_, used};
}

bool FewShapes::none_enters(const LinkRows& rows, const Dozen& slopes, double threshold) noexcept {
  return furthest_above(U_, now_.side, slopes, sizes_, threshold * rows.length(), place(shapes_)) <=
         0.0;
}

void FewShapes::solve_normal(Eigen::VectorXd& x) noexcept {
  Dozen right;
  Eigen::Index entry = 0;
  for (int j = 0; j < shapes_; ++j) {
    if (is_passive(j)) right[place(j)] = x[entry++];
  }
  entry = 0;
  for (int i = 0; i < shapes_; ++i) {
    if (!is_passive(i)) continue;
    double sum = 0.0;
    for (std::size_t j = 0; j < dozen; ++j) sum += now_.H[place(i)][j] * right[j];
    x[entry++] = sum;
  }
}

}  // namespace shapeid::fast
