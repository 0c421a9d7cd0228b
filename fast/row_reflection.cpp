#include "shapeid/fast/row_reflection.hpp"

#include <algorithm>

#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {
namespace {

using four_rows::numbers, four_rows::together;

/// Of `count` columns that begin at y, a stride apart, the products with v: n numbers, whole fours.
/// As many sums at once as make additions wait for none before.
template <Eigen::Index count>
[[gnu::always_inline]] inline void dot(const double* v, const double* y, Eigen::Index stride,
                                       Eigen::Index n, double (&products)[count]) noexcept {
  constexpr Eigen::Index sums_each = count == 1 ? 4 : count == 2 ? 2 : 1;
  Four sums[count][sums_each] = {}, a, b;
  Eigen::Index i = 0;
  for (; i + together * sums_each <= n; i += together * sums_each) {
    for (Eigen::Index s = 0; s < sums_each; ++s) {
      load(v + i + together * s, a);
      for (Eigen::Index k = 0; k < count; ++k) {
        load(y + k * stride + i + together * s, b);
        sums[k][s] += a * b;
      }
    }
  }
  for (; i < n; i += together) {
    load(v + i, a);
    for (Eigen::Index k = 0; k < count; ++k) {
      load(y + k * stride + i, b);
      sums[k][0] += a * b;
    }
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    Four sum = sums[k][0];
    for (Eigen::Index s = 1; s < sums_each; ++s) sum += sums[k][s];
    products[k] = (sum[0] + sum[2]) + (sum[1] + sum[3]);
  }
}

/// y -= shares v
template <Eigen::Index count>
[[gnu::always_inline]] inline void take_away(const double (&shares)[count], const double* v,
                                             double* y, Eigen::Index stride,
                                             Eigen::Index n) noexcept {
  for (Eigen::Index i = 0; i < n; i += together) {
    Four a, b;
    load(v + i, a);
    for (Eigen::Index k = 0; k < count; ++k) {
      load(y + k * stride + i, b);
      b -= shares[k] * a;
      store(b, y + k * stride + i);
    }
  }
}

/// As a column that leaves makes them.
[[gnu::always_inline]] inline bool is_short(const RowReflection& r) noexcept {
  return r.end - r.first == 2;
}

/// `count` columns by one reflection after the other.
template <Eigen::Index count>
[[gnu::always_inline]] inline void reflect_some(const RowReflection* from, const RowReflection* to,
                                                const double* vectors, ColumnBlock x) noexcept {
  Eigen::Index last = 0;
  for (Eigen::Index k = 0; k < count; ++k) last = std::max(last, x.ends[k]);
  for (const RowReflection* r = from; r != to; ++r) {
    if (r->first >= last) continue;  // meets zeros only
    last = std::max(last, r->end);
    for (Eigen::Index k = 0; k < count; ++k) {
      if (r->first < x.ends[k]) x.ends[k] = std::max(x.ends[k], r->end);
    }
    const double* v = vectors + r->place;
    if (is_short(*r)) {
      for (Eigen::Index k = 0; k < count; ++k) reflect_two(*r, v, x.first + k * x.stride);
      continue;
    }
    double* y = x.first + four_rows::first(r->first);
    const Eigen::Index n = numbers(r->first, r->end);
    double shares[count];
    dot(v, y, x.stride, n, shares);
    for (double& share : shares) share *= r->scale;
    take_away(shares, v, y, x.stride, n);
  }
}

}  // namespace

SHAPEID_WIDE void reflect_columns(const RowReflection* from, const RowReflection* to,
                                  const double* vectors, ColumnBlock x,
                                  Eigen::Index count) noexcept {
  for (; count >= 4; count -= 4) {
    reflect_some<4>(from, to, vectors, x);
    x = {x.first + 4 * x.stride, x.stride, x.ends + 4};
  }
  if (count == 3) reflect_some<3>(from, to, vectors, x);
  if (count == 2) reflect_some<2>(from, to, vectors, x);
  if (count == 1) reflect_some<1>(from, to, vectors, x);
}

SHAPEID_WIDE double square_of(const double* x, Eigen::Index first, Eigen::Index end) noexcept {
  double square = 0.0;
  for (; first < end && first % together != 0; ++first) square += x[first] * x[first];
  if (first >= end) return square;
  double rest[1];
  dot(x + first, x + first, 0, numbers(first, end), rest);
  return square + rest[0];
}

}  // namespace shapeid::fast
