#include "shapeid/fast/link_rows.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

namespace shapeid::fast {
namespace {

using Ten = std::array<Dozen, 10>;

/// A residual whose square is below this share of || b ||^2 is rounding of its own sums.
constexpr double residual_rounding = 1e-30;

/// Four columns from x on become parts of four rows, and their absolute values are added to `sum`.
/// `count`: columns that are there; `down`: rows.
[[gnu::always_inline]] inline void take_block(const double* x, std::ptrdiff_t stride, int count,
                                              int down, Dozen* rows, std::size_t part,
                                              Dozen& sum) noexcept {
  Four block[4];
  for (std::ptrdiff_t k = 0; k < 4; ++k) {
    const double* column = x + k * stride;
    if (k >= count) {
      block[k] = Four{};
    } else if (down == 4) {
      load(column, block[k]);
    } else {
      block[k] = Four{column[0], column[1], column[0], column[1]};
      keep_two(block[k]);
    }
  }
  transpose(block);
  for (std::ptrdiff_t k = 0; k < down; ++k) {
    rows[k].part[part] = block[k];
    take_sign(block[k]);
    sum.part[part] += block[k];
  }
}

/// Rows of [R c 0] and the sums of the absolute values in its columns. R is zero below its
/// diagonal.
SHAPEID_WIDE void read(const double* R, std::ptrdiff_t stride, Ten& rows,
                       std::array<Dozen, 11>& columns, Dozen& lengths) noexcept {
  for (std::size_t c = 0; c < 11; ++c) {
    load_ten(R + static_cast<std::ptrdiff_t>(c) * stride, columns[c]);
  }
  Dozen sum;
  Dozen* row = rows.data();
  take_block(R, stride, 4, 4, row, 0, sum);
  take_block(R + 4 * stride, stride, 4, 4, row, 1, sum);
  take_block(R + 4 * stride + 4, stride, 4, 4, row + 4, 1, sum);
  take_block(R + 8 * stride, stride, 3, 4, row, 2, sum);
  take_block(R + 8 * stride + 4, stride, 3, 4, row + 4, 2, sum);
  take_block(R + 8 * stride + 8, stride, 3, 2, row + 8, 2, sum);
  for (std::size_t i = 4; i < 10; ++i) rows[i].part[0] = Four{};
  for (std::size_t i = 8; i < 10; ++i) rows[i].part[1] = Four{};
  lengths = sum;
}

/// The triangle and the columns of U.
struct Data {
  const Ten& rows;
  const std::array<Dozen, 11>& columns;
  const double* U;  ///< ten numbers a shape
};

/// From Phi = U m.
[[gnu::always_inline]] inline void evaluate_parameters(const Data& data,
                                                       LinkRows::Value& value) noexcept {
  // Two sums each, so that one addition need not wait for the other.
  Dozen r = data.columns[10], odd;
  for (std::size_t i = 0; i < 10; i += 2) {
    add(r, -value.Phi[i], data.columns[i]);
    add(odd, -value.Phi[i + 1], data.columns[i + 1]);
  }
  add(r, 1.0, odd);
  value.square = dot(r, r);
  Dozen g, other;
  for (std::size_t i = 0; i < 10; i += 2) {
    add(g, r[i], data.rows[i]);
    add(other, r[i + 1], data.rows[i + 1]);
  }
  add(g, 1.0, other);
  keep_two(g.part[2]);
  value.slopes = g;
}

SHAPEID_WIDE void evaluate_masses(const Data& data, const int* shapes, const double* masses,
                                  std::size_t n, LinkRows::Value& value) noexcept {
  Dozen Phi, odd, u;  // two sums, so that one addition need not wait for the other
  std::size_t k = 0;
  for (; k + 2 <= n; k += 2) {
    load_ten(data.U + std::ptrdiff_t{10} * shapes[k], u);
    add(Phi, masses[k], u);
    load_ten(data.U + std::ptrdiff_t{10} * shapes[k + 1], u);
    add(odd, masses[k + 1], u);
  }
  if (k < n) {
    load_ten(data.U + std::ptrdiff_t{10} * shapes[k], u);
    add(Phi, masses[k], u);
  }
  add(Phi, 1.0, odd);
  value.Phi = Phi;
  evaluate_parameters(data, value);
}

[[gnu::always_inline]] inline void keep(Dozen& a, const FourBits (&used)[3]) noexcept {
  for (std::size_t p = 0; p < 3; ++p) {
    a.part[p] = reinterpret_cast<Four>(reinterpret_cast<FourBits>(a.part[p]) & used[p]);
  }
}

/// Whether a > b at any of the places kept.
[[gnu::always_inline]] inline bool any_above(const Dozen& a, const Dozen& b,
                                             const FourBits (&used)[3]) noexcept {
  FourBits any = {};
  for (std::size_t p = 0; p < 3; ++p) {
    any |= reinterpret_cast<FourBits>(a.part[p] > b.part[p]) & used[p];
  }
  return ((any[0] | any[1]) | (any[2] | any[3])) != 0;
}

[[gnu::always_inline]] inline bool all_positive(const Dozen& a,
                                                const FourBits (&used)[3]) noexcept {
  FourBits any = {};
  for (std::size_t p = 0; p < 3; ++p) {
    any |= ~reinterpret_cast<FourBits>(a.part[p] > 0.0) & used[p];
  }
  return ((any[0] | any[1]) | (any[2] | any[3])) == 0;
}

/// A bit a place, of those used. What is no number is neither.
[[gnu::always_inline]] inline unsigned not_positive(const Dozen& a, unsigned used) noexcept {
  unsigned places = 0;
  for (unsigned left = used; left != 0; left &= left - 1) {
    if (a[static_cast<std::size_t>(std::countr_zero(left))] <= 0.0) places |= left & -left;
  }
  return places;
}

struct Limits {
  double refined;
  int most;
  double exact;
  double unreached;  ///< square of what no parameter reaches
};

SHAPEID_WIDE void settle_masses(const Data& data, const AtPlaces& passive, double length,
                                const Dozen& stiffness, const Limits& limits,
                                LinkRows::Settled& settled) noexcept {
  constexpr FourBits places[] = {{1, 2, 4, 8}, {16, 32, 64, 128}, {256, 512, 1024, 2048}};
  FourBits used[3];
  for (std::size_t p = 0; p < 3; ++p) {
    used[p] = reinterpret_cast<FourBits>((places[p] & passive.used) != 0);
  }
  const Ten& U = *passive.U;
  Dozen allowed = *passive.sizes;  // of a slope
  for (Four& part : allowed.part) part *= limits.refined * length;
  Dozen m = *passive.m;
  keep(m, used);
  settled.m = m;
  settled.is_settled = false;
  settled.below = 0;
  settled.corrections = 0;
  bool once_more = true;
  while (true) {
    if (!all_positive(m, used)) {
      settled.below = not_positive(m, passive.used);
      return;
    }
    Dozen Phi, u;
    for (unsigned left = passive.used; left != 0; left &= left - 1) {
      const auto place = static_cast<std::size_t>(std::countr_zero(left));
      load_ten(data.U + std::ptrdiff_t{10} * passive.shape[place], u);
      add(Phi, settled.m[place], u);
    }
    settled.at.Phi = Phi;
    evaluate_parameters(data, settled.at);
    Dozen slope, odd;
    for (std::size_t i = 0; i < 10; i += 2) {
      add(slope, settled.at.slopes[i], U[i]);
      add(odd, settled.at.slopes[i + 1], U[i + 1]);
    }
    for (std::size_t p = 0; p < 3; ++p) {
      slope.part[p] += odd.part[p];
      slope.part[p] -= stiffness.part[p] * m.part[p];
    }
    keep(slope, used);
    Dozen size = slope;
    for (Four& part : size.part) take_sign(part);
    const bool is_settled = !any_above(size, allowed, used);
    // Slopes are small beside || b ||. Where the rows are met almost exactly, masses have more
    // digits than that shows, and one more correction gains them, until the residual is rounding.
    const bool is_exact = settled.at.square + limits.unreached < limits.exact * length * length;
    const bool is_rounding = settled.at.square <= residual_rounding * length * length;
    if (is_settled && !(once_more && is_exact && !is_rounding)) break;
    if (is_settled) once_more = false;
    if (!is_settled && (settled.corrections == limits.most || !once_more)) return;
    ++settled.corrections;
    const Dozen right = slope;
    for (unsigned left = passive.used; left != 0; left &= left - 1) {
      const auto place = static_cast<std::size_t>(std::countr_zero(left));
      add(m, right[place], passive.inverse[place]);
    }
    keep(m, used);
    settled.m = m;
  }
  // Masses beside a large lambda have squares that are no numbers any more.
  Dozen weighted = stiffness;
  for (std::size_t p = 0; p < 3; ++p) weighted.part[p] *= m.part[p];
  settled.density = dot(weighted, m);
  settled.is_settled = true;
}

}  // namespace

void LinkRows::take(const Eigen::MatrixXd& R) noexcept {
  read(R.data(), R.outerStride(), rows_, columns_, lengths_);
  length_ = R.col(10).norm();
  unreached_ = R(10, 10);
}

void LinkRows::evaluate(const ShapeColumns& columns, const std::vector<int>& passive,
                        const std::vector<double>& masses, Value& value) const noexcept {
  evaluate_masses({rows_, columns_, columns.data()}, passive.data(), masses.data(), passive.size(),
                  value);
}

void LinkRows::settle(const ShapeColumns& columns, const AtPlaces& passive, const Dozen& stiffness,
                      double refined, int most, double exact, Settled& settled) const noexcept {
  settle_masses({rows_, columns_, columns.data()}, passive, length_, stiffness,
                {refined, most, exact, unreached_ * unreached_}, settled);
}

}  // namespace shapeid::fast
