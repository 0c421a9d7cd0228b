#include "shapeid/fast/tableau_split.hpp"

#include <bit>
#include <cmath>
#include <cstddef>

namespace shapeid::fast::tableau {
namespace {

/// A column of which less than this share of its bound's square is new is within the span of the
/// passive ones: rounding of M.
constexpr double spanned_share = 1e-13;

/// Coefficients below this are not divided by.
constexpr double smallest_coefficient = 1e-3;

/// The part that goes, which was looked at, enters at `other`. The whole's column is the sum of the
/// parts' columns, each times its size, so that masses go over.
[[gnu::always_inline]] inline void part_from(Tableau& t, const Image& image, std::size_t place,
                                             std::size_t other, const Parts& parts) noexcept {
  enter_at(t, image, other, parts.j, parts.goes);
  const Others others = others_than(place), before = others_than(other);
  Dozen ones;
  for (Four& part : ones.part) part += 1.0;
  const Dozen remain = with(ones, others, parts.sizes[0]);
  const Dozen go = with(Dozen{}, before, parts.sizes[1]);
  const auto turn = [&](Dozen& row) {
    const double whole = row[place];
    for (std::size_t p = 0; p < 3; ++p) {
      row.part[p] = remain.part[p] * row.part[p] + whole * go.part[p];
    }
  };
  for (Dozen& row : t.C) turn(row);
  turn(t.m);
  add(t.K[other], parts.sizes[1], t.K[place]);
  t.K[place] = times(parts.sizes[0], t.K[place]);
  for (std::size_t q = 0; q < t.places; ++q) turn(t.K[q]);
  t.diagonal = with(with(t.diagonal, others, t.K[place][place]), before, t.K[other][other]);
}

/// The shape at this place gives way to one whose column is the passive ones times y: their span
/// stays, and with it M and g; masses move, with R U m as it is.
[[gnu::always_inline]] inline void exchange_within(Tableau& t, std::size_t place,
                                                   const Dozen& y) noexcept {
  const double inverse = 1.0 / y[place];
  const Dozen h = with(times(inverse, y), others_than(place), 1.0 - inverse);
  // K becomes (I - h e^T) K (I - e h^T) = K - h v^T - v h^T.
  Dozen v = t.K[place];
  add(v, -0.5 * v[place], h);
  for (std::size_t p = 0; p < 3; ++p) t.diagonal.part[p] -= 2.0 * h.part[p] * v.part[p];
  add(t.m, -t.m[place], h);
  for (Dozen& c : t.C) add(c, -c[place], h);
  for (std::size_t q = 0; q < t.places; ++q) {
    add(t.K[q], -h[q], v);
    add(t.K[q], -v[q], h);
  }
}

/// The place that is the last to be without negative mass while mass goes over to a shape whose
/// column is the passive ones times x; most_passive if no mass is negative.
[[gnu::always_inline]] inline std::size_t last_below(const Tableau& t, const Dozen& x) noexcept {
  std::size_t last = most_passive;
  double given = 0.0;
  for (unsigned left = t.used; left != 0; left &= left - 1) {
    const std::size_t place = static_cast<std::size_t>(std::countr_zero(left));
    if (!(t.m[place] < 0.0 && t.m[place] / x[place] > given)) continue;
    given = t.m[place] / x[place];
    last = place;
  }
  return last;
}

/// Both parts are the passive columns times something, that which goes times x. So that which
/// remains can take all of the mass, among the others; and if one of those has less than none then,
/// the other part takes its place.
[[gnu::always_inline]] inline Split split_within(Tableau& t, Dozen x, std::size_t place,
                                                 const Parts& parts) noexcept {
  const Others others = others_than(place);
  const double share = 1.0 / parts.sizes[0], whole = parts.sizes[1] * x[place];
  const Dozen y = with(times(-share * parts.sizes[1], x), others, share * (1.0 - whole));
  if (!(std::abs(y[place]) > smallest_coefficient)) return {false, most_passive};
  const double factor = x[place] / y[place];
  add(x, -factor, y);
  x = with(x, others, factor);
  exchange_within(t, place, y);
  for (std::size_t i = 0; i < 10; ++i) t.U[i][place] = parts.remains[i];
  const std::size_t last = last_below(t, x);
  if (last == most_passive || !(std::abs(x[last]) > smallest_coefficient)) {
    return {true, most_passive};  // if need be, pivots go on
  }
  exchange_within(t, last, x);
  for (std::size_t i = 0; i < 10; ++i) t.U[i][last] = parts.goes[i];
  t.shape[last] = parts.j;
  return {true, last};
}

}  // namespace

SHAPEID_WIDE_AND_MANY Split split(Tableau& t, std::size_t place, const Parts& parts) noexcept {
  Image image;
  look_at(t, parts.goes, parts.stiffness, image);
  if (parts.shared > 0.0) {
    image.left -= parts.shared * (2.0 * image.x[place] + parts.shared * t.diagonal[place]);
    image.slope -= parts.shared * t.m[place];
    add(image.s, -parts.shared, coefficients(t, place));
    add(image.x, parts.shared, t.K[place]);
  }
  const double square = parts.bound * parts.bound;
  const std::size_t free = free_place(t);
  if (image.left > smallest_share * square && free != most_passive) {
    part_from(t, image, place, free, parts);
    for (std::size_t i = 0; i < 10; ++i) t.U[i][place] = parts.remains[i];
    return {true, free};
  }
  if (parts.stiffness > 0.0 || !(image.left <= spanned_share * square)) {
    return {false, most_passive};
  }
  return split_within(t, image.x, place, parts);
}

}  // namespace shapeid::fast::tableau
