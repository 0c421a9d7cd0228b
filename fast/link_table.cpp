// Derivation: docs/derivations/fast-masses.md.
#include "shapeid/fast/link_table.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>

#include "shapeid/fast/tableau_split.hpp"

namespace shapeid::fast {
namespace {

/// What an answer is checked against (ActiveSet's allowed_slope).
constexpr double allowed_rounding = 1e-10;

Lane lane(ShapeColumns& columns, int j) noexcept {
  const ShapeColumns::Slot& slot = columns.slot(j);
  return {columns.chunks() + slot.chunk, static_cast<std::size_t>(slot.lane)};
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
  leaving_ = 0;
  problem_.U = columns_->data();
  problem_.V = V_->data();
  problem_.chunks = columns_->chunks();
  problem_.lambda = lambda;
  problem_.largest = columns_->largest();
  problem_.inverse_unit = columns_->inverse_unit();
  problem_.inverse_length = rows.length() > 0.0 ? 1.0 / rows.length() : 0.0;
  problem_.smallest_left = tableau::smallest_share * problem_.largest * problem_.largest;
  columns_->unbar_all();
  tableau::fill(now_, rows.rows(), rows.lengths(), problem_.inverse_lengths);
  if (passive.size() > most_passive) return false;
  for (const int j : passive) static_cast<void>(enter_shape(j));
  return true;
}

bool LinkTable::enter_shape(int j) noexcept {
  return tableau::enter(now_, problem_, lane(*columns_, j));
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
  leaving_ = 0;
  std::size_t place = 0;
  while (place < most_passive && !(is_used(place) && now_.shape[place] == j)) ++place;
  if (place == most_passive) return true;  // it has no mass
  const double V = V1 + V2, lambda = problem_.lambda;
  const unsigned before = now_.used;
  const auto [is_clear, at_other] = tableau::split(now_, place,
                                                   {.remains = columns_->column(j).data(),
                                                    .goes = columns_->column(other).data(),
                                                    .sizes = {V1 / V, V2 / V},
                                                    .j = other,
                                                    .bound = columns_->bound(other),
                                                    .shared = lambda > 0.0 ? lambda / V : 0.0,
                                                    .stiffness = lambda > 0.0 ? lambda / V2 : 0.0});
  if (!is_clear) {
    tableau::leave(now_, place);
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
  for (unsigned left = std::exchange(leaving_, 0U); left != 0; left &= left - 1) {
    ++pivots_;
    tableau::leave(now_, static_cast<std::size_t>(std::countr_zero(left)));
  }
  if (const int j = std::exchange(wanting_, -1); j >= 0) {
    ++pivots_;
    if (!enter_shape(j)) return false;
  }
  const tableau::Stop stop = tableau::pivot(now_, problem_, 40 + 4 * columns_->size(), pivots_);
  doubtful_.count = 0;
  knows_doubtful_ =
      stop == tableau::Stop::settled ||
      (stop == tableau::Stop::doubtful && tableau::find_doubtful(now_.g, problem_, doubtful_));
  return stop != tableau::Stop::endless;
}

AtPlaces LinkTable::answer() const noexcept {
  return {&now_.U, now_.K.data(), now_.shape.data(), &now_.m, &now_.sizes, now_.used};
}

// Shapes that certainly did not want to enter at the slopes of the table need not be asked if these
// are the same to what an answer is checked against. As many passive shapes as rows were not asked
// at all: their slopes are to be nothing.
bool LinkTable::none_enters(const Dozen& slopes, double threshold) noexcept {
  Dozen apart = slopes;
  if (!tableau::is_full(now_, problem_)) add(apart, -1.0, now_.g);
  int j = -1;
  if (knows_doubtful_ && threshold > 0.0 &&
      tableau::largest_of(apart, problem_.inverse_lengths) <= allowed_rounding * rows_->length()) {
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
    add(z, x[entry++], now_.K[static_cast<std::size_t>(std::countr_zero(left))]);
  }
  entry = 0;
  for (unsigned left = now_.used; left != 0; left &= left - 1) {
    x[entry++] = z[static_cast<std::size_t>(std::countr_zero(left))];
  }
}

}  // namespace shapeid::fast
