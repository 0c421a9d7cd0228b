// Derivation: docs/derivations/fast-masses.md.
#include "shapeid/fast/link_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "shapeid/fast/price_chunk.hpp"

namespace shapeid::fast {
namespace {

using Table = LinkTable::Exchanged;
using Problem = LinkTable::Problem;
using Ten = std::array<Dozen, 10>;

/// A column of which less than this share of its bound's square is new counts as dependent:
/// rounding of M may be a hundredth of it.
constexpr double smallest_share = 1e-12;

/// A column of which less than this share of its bound's square is new is within the span of the
/// passive ones: rounding of M.
constexpr double spanned_share = 1e-13;

/// Coefficients below this are not divided by.
constexpr double smallest_coefficient = 1e-3;

/// Prices below this are not followed: rounding of M may be as large.
constexpr double smallest_price = 1e-13;

/// What an answer is checked against (ActiveSet's allowed_slope).
constexpr double allowed_rounding = 1e-10;

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

/// Whether there are as many passive shapes as rows: then no row is left that a slope could come
/// from.
[[gnu::always_inline]] inline bool is_full(const Table& t, const Problem& problem) noexcept {
  return problem.lambda == 0.0 && t.count == 10;
}

/// The first place that is free; most_passive if none is.
[[gnu::always_inline]] inline std::size_t free_place(const Table& t) noexcept {
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

[[gnu::always_inline]] inline void look_at(const Table& t, const double* column, double stiffness,
                                           Image& image) noexcept {
  // Two sums each, so that one addition need not wait for the other.
  Dozen u, s, x, odd_s, odd_x;
  load_ten(column, u);
  for (std::size_t i = 0; i < 10; i += 2) {
    add(s, column[i], t.M[i]);
    add(x, column[i], t.C[i]);
    add(odd_s, column[i + 1], t.M[i + 1]);
    add(odd_x, column[i + 1], t.C[i + 1]);
  }
  add(s, 1.0, odd_s);
  add(x, 1.0, odd_x);
  image.left = dot(s, u) + stiffness;
  image.slope = dot(t.g, u);
  image.s = s;
  image.x = x;
}

/// The shape looked at becomes passive at this place, which is free.
[[gnu::always_inline]] inline void enter_at(Table& t, const Image& image, std::size_t place, int j,
                                            const double* column) noexcept {
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
  for (std::size_t i = 0; i < 10; ++i) {
    add(t.M[i], f[i], s);
    add(t.C[i], f[i], x);
  }
  t.K[place] = Dozen{};
  for (std::size_t q = 0; q < t.places; ++q) add(t.K[q], h[q], x);
}

/// The coefficients of the shape at this place.
[[gnu::always_inline]] inline Dozen coefficients(const Table& t, std::size_t place) noexcept {
  const Ten& C = t.C;
  Dozen c;
  c.part[0] = Four{C[0][place], C[1][place], C[2][place], C[3][place]};
  c.part[1] = Four{C[4][place], C[5][place], C[6][place], C[7][place]};
  c.part[2] = Four{C[8][place], C[9][place], C[8][place], C[9][place]};
  keep_two(c.part[2]);
  return c;
}

[[gnu::always_inline]] inline void take_out(Table& t, std::size_t place) noexcept {
  const Dozen c = coefficients(t, place), k = t.K[place];
  const double inverse = 1.0 / t.diagonal[place], mass = t.m[place] * inverse;
  const Others others = others_than(place);
  const Dozen f = times(inverse, c), h = times(-inverse, k);
  add(t.g, mass, c);
  add(t.m, -mass, k);
  t.m = with(t.m, others, 1.0);
  for (std::size_t p = 0; p < 3; ++p) t.diagonal.part[p] += h.part[p] * k.part[p];
  t.diagonal = with(t.diagonal, others, 1.0);
  for (std::size_t i = 0; i < 10; ++i) {
    add(t.M[i], f[i], c);
    add(t.C[i], -f[i], k);
    clear_one(t.C[i], others);
  }
  for (std::size_t q = 0; q < t.places; ++q) {
    add(t.K[q], h[q], k);
    clear_one(t.K[q], others);
  }
  t.used &= ~(1U << place);
  --t.count;
}

/// Whether a mass is zero or negative.
[[gnu::always_inline]] inline bool some_below(const Table& t) noexcept {
  FourBits below = {};
  for (const Four& m : t.m.part) below |= reinterpret_cast<FourBits>(m <= 0.0);
  return ((below[0] | below[1]) | (below[2] | below[3])) != 0;
}

/// The place whose mass, zero or negative, costs most to be held at zero, m^2 over its entry of K;
/// only if there is one. The low bits of each cost carry its place, so that one maximum finds both.
[[gnu::always_inline]] inline std::size_t furthest_below(const Table& t) noexcept {
  Four most = Four{} - 1.0;
  for (std::size_t p = 0; p < 3; ++p) {
    const Four m = t.m.part[p];
    const Four out = m > 0.0 ? Four{} - 1.0 : m * m / t.diagonal.part[p];
    const Four marked =
        reinterpret_cast<Four>((reinterpret_cast<FourBits>(out) & ~place_bits) | dozen_places[p]);
    most = marked > most ? marked : most;
  }
  const double found = std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
  return std::bit_cast<std::uint64_t>(found) & place_bits;
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

/// False if the shape depends on the passive ones, or there is no place for it.
[[gnu::always_inline]] inline bool enter(Table& t, const Problem& problem,
                                         const Lane& lane) noexcept {
  const std::size_t place = free_place(t);
  if (place == LinkTable::most_passive) return false;
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

[[gnu::always_inline]] inline void leave(Table& t, std::size_t place) noexcept {
  take_out(t, place);
  t.lane[place].bar(0.0F);
}

SHAPEID_WIDE void leave_one(Table& t, std::size_t place) noexcept { leave(t, place); }

SHAPEID_WIDE bool enter_one(Table& t, const Problem& problem, const Lane& lane) noexcept {
  return enter(t, problem, lane);
}

/// What single precision can tell from zero, if no slope makes a larger price than `possible`.
[[gnu::always_inline]] inline double visible(double possible) noexcept {
  return static_cast<double>(uncertain) * possible;
}

enum class Stop {
  settled,   ///< nothing wants to enter
  doubtful,  ///< single precision cannot tell, or what wants to enter cannot
  endless
};

/// A mass that is not positive leaves, or else the steepest shape enters; `pivots` counts them.
SHAPEID_WIDE Stop pivot(Table& t, const Problem& problem, int most_pivots, int& pivots) noexcept {
  for (; pivots < most_pivots; ++pivots) {
    if (some_below(t)) {
      leave(t, furthest_below(t));
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
    if (!is_certain || !enter(t, problem, lane)) return Stop::doubtful;
  }
  return Stop::endless;
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

/// The shapes whose slope single precision does not show to be negative; false if there are too
/// many.
SHAPEID_WIDE bool find_doubtful(const Dozen& g, const Problem& problem,
                                LinkTable::Doubtful& doubtful) noexcept {
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
      doubtful.shapes[doubtful.count++] = chunk.shape[at(std::countr_zero(left))];
    }
  }
  return true;
}

/// M of rows [R c]: four rows of M at a time, from the rows of R that reach them.
template <std::size_t first, std::size_t count>
[[gnu::always_inline]] inline void fill_rows(Table& t, const Ten& rows) noexcept {
  Dozen sum[count];
  for (std::size_t i = 0; i < first + count; ++i) {
    for (std::size_t k = 0; k < count; ++k) add(sum[k], rows[i][first + k], rows[i]);
  }
  for (std::size_t k = 0; k < count; ++k) {
    keep_two(sum[k].part[2]);
    t.M[first + k] = sum[k];
  }
}

/// No passive shapes. K is written as they enter.
SHAPEID_WIDE void fill(Table& t, const Ten& rows, const Dozen& lengths,
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

/// A division: of the whole one part remains, and the other, shape `j`, goes.
struct Parts {
  const double *remains, *goes;  ///< their columns
  double sizes[2];               ///< what they are of the whole's volume
  int j;
  double bound;      ///< of the length of R times the column that goes
  double shared;     ///< stiffness of the whole, which both feel as long as they move together
  double stiffness;  ///< of the part that goes
};

/// The part that goes, which was looked at, enters at `other`. The whole's column is the sum of the
/// parts' columns, each times its size, so that masses go over.
[[gnu::always_inline]] inline void part_from(Table& t, const Image& image, std::size_t place,
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
[[gnu::always_inline]] inline void exchange_within(Table& t, std::size_t place,
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
[[gnu::always_inline]] inline std::size_t last_below(const Table& t, const Dozen& x) noexcept {
  std::size_t last = LinkTable::most_passive;
  double given = 0.0;
  for (unsigned left = t.used; left != 0; left &= left - 1) {
    const std::size_t place = at(std::countr_zero(left));
    if (!(t.m[place] < 0.0 && t.m[place] / x[place] > given)) continue;
    given = t.m[place] / x[place];
    last = place;
  }
  return last;
}

struct Split {
  bool is_clear;  ///< or nothing has changed
  /// Where the part that goes is passive; most_passive if nowhere.
  std::size_t other;
};

/// Both parts are the passive columns times something, that which goes times x. So that which
/// remains can take all of the mass, among the others; and if one of those has less than none then,
/// the other part takes its place.
[[gnu::always_inline]] inline Split split_within(Table& t, Dozen x, std::size_t place,
                                                 const Parts& parts) noexcept {
  const Others others = others_than(place);
  const double share = 1.0 / parts.sizes[0], whole = parts.sizes[1] * x[place];
  const Dozen y = with(times(-share * parts.sizes[1], x), others, share * (1.0 - whole));
  if (!(std::abs(y[place]) > smallest_coefficient)) return {false, LinkTable::most_passive};
  const double factor = x[place] / y[place];
  add(x, -factor, y);
  x = with(x, others, factor);
  exchange_within(t, place, y);
  for (std::size_t i = 0; i < 10; ++i) t.U[i][place] = parts.remains[i];
  const std::size_t last = last_below(t, x);
  if (last == LinkTable::most_passive || !(std::abs(x[last]) > smallest_coefficient)) {
    return {true, LinkTable::most_passive};  // if need be, pivots go on
  }
  exchange_within(t, last, x);
  for (std::size_t i = 0; i < 10; ++i) t.U[i][last] = parts.goes[i];
  t.shape[last] = parts.j;
  return {true, last};
}

/// Of the shape at `place`. Not clear where the parts can hardly be told apart.
SHAPEID_WIDE Split split(Table& t, std::size_t place, const Parts& parts) noexcept {
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
  if (image.left > smallest_share * square && free != LinkTable::most_passive) {
    part_from(t, image, place, free, parts);
    for (std::size_t i = 0; i < 10; ++i) t.U[i][place] = parts.remains[i];
    return {true, free};
  }
  if (parts.stiffness > 0.0 || !(image.left <= spanned_share * square)) {
    return {false, LinkTable::most_passive};
  }
  return split_within(t, image.x, place, parts);
}

Lane lane(ShapeColumns& columns, int j) noexcept {
  const ShapeColumns::Slot& slot = columns.slot(j);
  return {columns.chunks() + slot.chunk, at(slot.lane)};
}

}  // namespace

LinkTable::LinkTable(ShapeColumns& columns, const Eigen::VectorXd& V)
    : columns_(&columns), V_(&V), slopes_(Eigen::VectorXd::Zero(10)) {
  now_.U.fill(Dozen{});
}

bool LinkTable::start(const LinkRows& rows, double lambda,
                      const std::vector<int>& passive) noexcept {
  rows_ = &rows;
  pivots_ = 0;
  wanting_ = -1;
  problem_.U = columns_->data();
  problem_.V = V_->data();
  problem_.chunks = columns_->chunks();
  problem_.lambda = lambda;
  problem_.largest = columns_->largest();
  problem_.inverse_unit = columns_->inverse_unit();
  problem_.inverse_length = rows.length() > 0.0 ? 1.0 / rows.length() : 0.0;
  problem_.smallest_left = smallest_share * problem_.largest * problem_.largest;
  columns_->unbar_all();
  fill(now_, rows.rows(), rows.lengths(), problem_.inverse_lengths);
  if (passive.size() > most_passive) return false;
  for (const int j : passive) static_cast<void>(enter_shape(j));
  return true;
}

bool LinkTable::enter_shape(int j) noexcept {
  return enter_one(now_, problem_, lane(*columns_, j));
}

void LinkTable::correct(const Dozen& masses, const Dozen& slopes) noexcept {
  for (std::size_t p = 0; p < 3; ++p) {
    const Four m = masses.part[p];
    now_.m.part[p] = m > 0.0 ? m : now_.m.part[p];
  }
  now_.g = slopes;
  pivots_ = 0;
}

bool LinkTable::divide(int j, int other, double V1, double V2) noexcept {
  wanting_ = -1;
  std::size_t place = 0;
  while (place < most_passive && !(is_used(place) && now_.shape[place] == j)) ++place;
  if (place == most_passive) return true;  // it has no mass
  const double V = V1 + V2, lambda = problem_.lambda;
  const unsigned before = now_.used;
  const auto [is_clear, at_other] = split(now_, place,
                                          {.remains = columns_->column(j).data(),
                                           .goes = columns_->column(other).data(),
                                           .sizes = {V1 / V, V2 / V},
                                           .j = other,
                                           .bound = columns_->bound(other),
                                           .shared = lambda > 0.0 ? lambda / V : 0.0,
                                           .stiffness = lambda > 0.0 ? lambda / V2 : 0.0});
  if (!is_clear) {
    leave_one(now_, place);
    static_cast<void>(enter_shape(j));
    return true;
  }
  now_.sizes[place] = columns_->bound(j);
  if (at_other == most_passive) return true;
  if ((before >> at_other & 1U) != 0) now_.lane[at_other].bar(0.0F);
  now_.sizes[at_other] = columns_->bound(other);
  now_.lane[at_other] = lane(*columns_, other);
  now_.lane[at_other].bar(barred);
  return true;
}

// Four pivots for each parameter and each shape that there may be: in practice two or three a
// passive shape.
bool LinkTable::settle() noexcept {
  problem_.count = columns_->used_chunks();
  if (const int j = std::exchange(wanting_, -1); j >= 0) {
    ++pivots_;
    if (!enter_shape(j)) return false;
  }
  const Stop stop = pivot(now_, problem_, 40 + 4 * columns_->size(), pivots_);
  doubtful_.count = 0;
  knows_doubtful_ = stop == Stop::settled ||
                    (stop == Stop::doubtful && find_doubtful(now_.g, problem_, doubtful_));
  return stop != Stop::endless;
}

AtPlaces LinkTable::answer() const noexcept {
  return {&now_.U, now_.K.data(), now_.shape.data(), &now_.m, &now_.sizes, now_.used};
}

// Shapes that certainly did not want to enter at the slopes of the table need not be asked if these
// are the same to what an answer is checked against. As many passive shapes as rows were not asked
// at all: their slopes are to be nothing.
bool LinkTable::none_enters(const Dozen& slopes, double threshold) noexcept {
  Dozen apart = slopes;
  if (!is_full(now_, problem_)) add(apart, -1.0, now_.g);
  int j = -1;
  if (knows_doubtful_ && threshold > 0.0 &&
      largest_of(apart, problem_.inverse_lengths) <= allowed_rounding * rows_->length()) {
    j = steepest_doubtful(slopes, threshold);
  } else {
    std::copy_n(slopes.data(), 10, slopes_.data());
    j = columns_->steepest(slopes_, threshold);
  }
  if (j >= 0 && slope_of(j, slopes) > 0.0) wanting_ = j;
  return j < 0;
}

double LinkTable::slope_of(int j, const Dozen& slopes) const noexcept {
  Dozen u;
  load_ten(columns_->column(j).data(), u);
  return dot(u, slopes);
}

/// In double: the one of the largest price above the threshold, or -1.
int LinkTable::steepest_doubtful(const Dozen& slopes, double threshold) const noexcept {
  int steepest = -1;
  for (std::size_t k = 0; k < doubtful_.count; ++k) {
    const int j = doubtful_.shapes[k];
    const double price = columns_->price(j, slope_of(j, slopes));
    if (!(price > threshold)) continue;
    threshold = price;
    steepest = j;
  }
  return steepest;
}

void LinkTable::solve_normal(Eigen::VectorXd& x) noexcept {
  Dozen z;
  Eigen::Index entry = 0;
  for (unsigned left = now_.used; left != 0; left &= left - 1) {
    add(z, x[entry++], now_.K[at(std::countr_zero(left))]);
  }
  entry = 0;
  for (unsigned left = now_.used; left != 0; left &= left - 1) {
    x[entry++] = z[at(std::countr_zero(left))];
  }
}

}  // namespace shapeid::fast
