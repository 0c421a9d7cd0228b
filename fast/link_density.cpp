#include "shapeid/fast/link_density.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace shapeid::fast {
namespace {

/// Columns of X, divided by their sizes, whose part that is new is smaller than this share of the
/// first pivot count as dependent: a hundred roundings of ten-term sums.
constexpr double smallest_pivot = 1e-13;

/// Slopes along a direction in which the passive shapes spread by less than this share are taken
/// from the residual. Its rounding, 1e-16 of the terms, reaches these shapes as 1e-18, still
/// nothing to the slopes that lambda makes (1e-12); to make it exact there would cost all other
/// shapes the inverse of this in digits.
constexpr double well_spread = 1e-2;

/// A direction that is left of a column by more than this share is one, far above what rounding
/// leaves of none.
constexpr double certainly_a_direction = 1e-6;

/// Of a triangle whose rank is taken as its diagonal shows it no entry exceeds that of the diagonal
/// in its row by more than this factor. (Pivots would make it one.)
constexpr double beside_diagonal = 10.0;

/// A row whose leverage is closer to one than this is not taken out of a triangle but left out of a
/// new one: taking it out would multiply rounding errors by the inverse of the distance's root.
constexpr double smallest_distance = 1e-2;

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

/// Rotations with the rows of the triangle, one after the other, make the new row zero.
SHAPEID_WIDE void add_row(TenRows& X, const double* ten) noexcept {
  Dozen row;
  load_ten(ten, row);
  for (std::size_t i = 0; i < 10; ++i) {
    const double lower = row[i];
    if (lower == 0.0) continue;
    const double upper = X[i][i];
    const double inverse = 1.0 / std::sqrt(upper * upper + lower * lower);
    const double c = upper * inverse, s = lower * inverse;
    for (std::size_t p = i / 4; p < 3; ++p) {
      const Four x = X[i].part[p], r = row.part[p];
      X[i].part[p] = c * x + s * r;
      row.part[p] = c * r - s * x;
    }
  }
}

/// With X^T a = row, X^T X - row row^T = X^T (1 - a a^T) X: rotations that gather (a, d), with d^2
/// = 1 - || a ||^2 the distance, in its last entry turn X below a row of zeros into what is left
/// above the row that goes (Saunders; LINPACK's dchdd). False, and nothing changes, if the row is
/// too near to all that X has in some direction.
SHAPEID_WIDE bool remove_row(TenRows& X, const double* ten) noexcept {
  Dozen row;
  load_ten(ten, row);
  std::array<double, 10> a;
  double distance = 1.0;
  for (std::size_t i = 0; i < 10; ++i) {
    const double diagonal = X[i][i];
    if (diagonal == 0.0) return false;
    a[i] = row[i] / diagonal;
    distance -= a[i] * a[i];
    for (std::size_t p = i / 4; p < 3; ++p) row.part[p] -= a[i] * X[i].part[p];
  }
  if (!(distance > smallest_distance)) return false;
  double square = distance, d = std::sqrt(distance);
  Dozen gone;
  for (std::size_t i = 10; i-- > 0;) {
    square += a[i] * a[i];
    const double length = std::sqrt(square), inverse = 1.0 / length;
    const double c = d * inverse, s = a[i] * inverse;
    d = length;
    for (std::size_t p = i / 4; p < 3; ++p) {
      const Four x = X[i].part[p], g = gone.part[p];
      gone.part[p] = c * g + s * x;
      X[i].part[p] = c * x - s * g;
    }
  }
  return true;
}

[[gnu::always_inline]] inline Dozen squares_from(const TenRows& rows, std::size_t k) noexcept {
  Dozen squares;
  for (std::size_t i = k; i < 10; ++i) {
    for (std::size_t p = 0; p < 3; ++p) squares.part[p] += rows[i].part[p] * rows[i].part[p];
  }
  return squares;
}

/// The place of the largest number, of those of which `open` is one.
[[gnu::always_inline]] inline std::size_t largest(const Dozen& x, const Dozen& open) noexcept {
  Four most = {};
  for (std::size_t p = 0; p < 3; ++p) {
    const Four here = open.part[p] * x.part[p];
    const Four marked =
        reinterpret_cast<Four>((reinterpret_cast<FourBits>(here) & ~place_bits) | dozen_places[p]);
    most = marked > most ? marked : most;
  }
  const double one = std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
  return std::bit_cast<std::uint64_t>(one) & place_bits;
}

/// What the ten columns measure, from the squares of their lengths: masses, first moments (mass and
/// tensor bound them), tensor. One where there is nothing.
[[gnu::always_inline]] inline Dozen sizes_of(const Dozen& squares) noexcept {
  const double mass = squares[0];
  double tensor = 0.0;
  for (std::size_t i = 4; i < 10; ++i) tensor = std::max(tensor, squares[i]);
  const auto size = [](double x) { return x > 0.0 ? std::sqrt(x) : 1.0; };
  const double m = size(mass), h = size(std::sqrt(mass * tensor)), I = size(tensor);
  Dozen sizes;
  sizes.part[0] = Four{m, h, h, h};
  sizes.part[1] = Four{I, I, I, I};
  sizes.part[2] = Four{I, I, 1.0, 1.0};
  return sizes;
}

struct Ranks {
  int rank = 0, certain = 0;
};

/// Householder's QR with column pivots of the triangle, columns staying where they are. They are
/// first divided by what bodies of this mass and size have in them, so that the rank does not
/// depend on units: and not by their own lengths, which would make a direction out of rounding
/// where shapes lie symmetrically.
SHAPEID_WIDE Ranks reveal_rank(const TenRows& X, int most, TenRows& E,
                               std::array<int, 10>& pivots) noexcept {
  const Dozen sizes = sizes_of(squares_from(X, 0));
  Dozen open;
  for (std::size_t p = 0; p < 3; ++p) {
    open.part[p] = dozen_places[p] < std::uint64_t{10} ? Four{} + 1.0 : Four{};
    const Four inverse = 1.0 / sizes.part[p];
    for (std::size_t i = 0; i < 10; ++i) E[i].part[p] = inverse * X[i].part[p];
  }
  Ranks ranks;
  double first = 0.0;
  for (std::size_t k = 0; k < at(most); ++k) {
    const Dozen squares = squares_from(E, k);
    const std::size_t pivot = largest(squares, open);
    const double length = std::sqrt(squares[pivot]);
    if (k == 0) first = length;
    if (!(length > smallest_pivot * first)) break;
    std::array<double, 10> v;
    for (std::size_t i = k; i < 10; ++i) v[i] = E[i][pivot];
    v[k] += v[k] > 0.0 ? length : -length;  // the signs agree, so that nothing cancels
    const double scale = 1.0 / (length * std::abs(v[k]));
    Dozen s;
    for (std::size_t i = k; i < 10; ++i) add(s, scale * v[i], E[i]);
    for (std::size_t i = k; i < 10; ++i) add(E[i], -v[i], s);
    for (std::size_t p = 0; p < 3; ++p) {
      open.part[p] = dozen_places[p] == pivot ? Four{} : open.part[p];
    }
    pivots[k] = static_cast<int>(pivot);
    ranks.rank = static_cast<int>(k) + 1;
    if (length > well_spread * first) ranks.certain = ranks.rank;
  }
  for (std::size_t i = 0; i < 10; ++i) {
    const bool remains = i < at(ranks.rank);
    for (std::size_t p = 0; p < 3; ++p) {
      E[i].part[p] = remains ? sizes.part[p] * E[i].part[p] : Four{};
    }
  }
  return ranks;
}

/// Whether the triangle itself shows its rank: ten, and in how many directions its shapes spread
/// well; none of its columns, measured as above, needs another place then, which is so most of the
/// time. `certain`: these directions, the first ones.
SHAPEID_WIDE bool shows_its_rank(const TenRows& X, int& certain) noexcept {
  const Dozen sizes = sizes_of(squares_from(X, 0));
  std::array<double, 10> left;  // of each column, beside those before it
  double longest = 0.0;
  for (std::size_t k = 0; k < 10; ++k) {
    Dozen row = X[k];
    Four most = {};
    for (std::size_t p = 0; p < 3; ++p) {
      row.part[p] /= sizes.part[p];
      take_sign(row.part[p]);
      const Four beside = dozen_places[p] > k ? row.part[p] : Four{};
      most = beside > most ? beside : most;
    }
    left[k] = row[k];
    const double in_row = std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
    longest = std::max(longest, std::max(in_row, left[k]));
    if (in_row > beside_diagonal * left[k]) return false;
  }
  certain = 0;
  while (certain < 10 && left[at(certain)] > well_spread * longest) ++certain;
  for (std::size_t k = at(certain); k < 10; ++k) {
    if (!(left[k] > certainly_a_direction * longest) || left[k] > well_spread * longest) {
      return false;
    }
  }
  return true;
}

/// What solves E w = y for the entries of w at the pivots.
SHAPEID_WIDE void prepare(const TenRows& E, const std::array<int, 10>& pivots, int rank,
                          Dozen& inverse_pivots, TenRows& above) noexcept {
  TenRows columns;
  transpose_ten(E, columns);
  for (std::size_t k = 0; k < at(rank); ++k) {
    above[k] = columns[at(pivots[k])];
    inverse_pivots[k] = 1.0 / above[k][k];
    scale_beside(Beside::before, k, inverse_pivots[k], above[k]);
  }
  for (std::size_t k = at(rank); k < 10; ++k) {
    above[k] = Dozen{};
    inverse_pivots[k] = 0.0;
  }
}

/// Of E w = y, w at the pivots, in their order; zero behind `rank`.
SHAPEID_WIDE void solve_pivots(const TenRows& above, const Dozen& inverse_pivots, int rank,
                               const double* y, double* w) noexcept {
  Dozen x;
  load_ten(y, x);
  const FourBits end = FourBits{} + static_cast<std::uint64_t>(rank);
  for (std::size_t p = 0; p < 3; ++p) x.part[p] = dozen_places[p] < end ? x.part[p] : Four{};
  solve_above<9>(above, x);
  for (std::size_t p = 0; p < 3; ++p) x.part[p] *= inverse_pivots.part[p];
  store_ten(x, w);
}

SHAPEID_WIDE void times(const TenRows& E, const double* ten, double* result) noexcept {
  Dozen x;
  load_ten(ten, x);
  for (std::size_t i = 0; i < 10; ++i) {
    const Four sum = E[i].part[0] * x.part[0] + E[i].part[1] * x.part[1] + E[i].part[2] * x.part[2];
    result[i] = (sum[0] + sum[2]) + (sum[1] + sum[3]);
  }
}

}  // namespace

void LinkDensity::clear() noexcept {
  begin_anew();
  shapes_ = 0;
  revealed_ = false;
}

void LinkDensity::begin_anew() noexcept {
  X_.fill(Dozen{});
  outdated_ = false;
}

void LinkDensity::again(const Ten& row) noexcept { add_row(X_, row.data()); }

void LinkDensity::enter(const Ten& row) noexcept {
  ++shapes_;
  revealed_ = false;
  if (!outdated_) add_row(X_, row.data());
}

void LinkDensity::leave(const Ten& row) noexcept {
  --shapes_;
  revealed_ = false;
  if (!outdated_ && !remove_row(X_, row.data())) outdated_ = true;
}

bool LinkDensity::reveal() noexcept {
  if (revealed_) return false;
  revealed_ = true;
  if (shapes_ >= 10 && shows_its_rank(X_, certain_)) {
    E_ = X_;
    std::iota(pivots_.begin(), pivots_.end(), 0);
    rank_ = 10;
  } else {
    const Ranks ranks = reveal_rank(X_, std::min(10, shapes_), E_, pivots_);
    rank_ = ranks.rank;
    certain_ = ranks.certain;
  }
  prepare(E_, pivots_, rank_, inverse_pivots_, above_);
  return true;
}

LinkDensity::Ten LinkDensity::weights(int rank, const Ten& y, const Ten& rest) const noexcept {
  Ten w = rest, found;
  for (int i = 0; i < rank; ++i) w[pivots_[at(i)]] = 0.0;
  const Ten left = rank < 10 ? Ten(y - share_of(w)) : y;
  solve_pivots(above_, inverse_pivots_, rank, left.data(), found.data());
  for (int i = 0; i < rank; ++i) w[pivots_[at(i)]] = found[i];
  return w;
}

LinkDensity::Ten LinkDensity::share_of(const Ten& g) const noexcept {
  Ten share;
  times(E_, g.data(), share.data());
  return share;
}

}  // namespace shapeid::fast
