#include "shapeid/fast/few_shapes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "shapeid/fast/few_table_pivots.hpp"
#include "shapeid/fast/few_table_split.hpp"
#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {
namespace {

/// A gain below the square of this share of || c || is rounding of H.
constexpr double smallest_step = 1e-13;

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
  leaving_ = 0;
  const std::size_t shapes = place(shapes_);
  rows_ = &rows;
  lambda_ = lambda;
  const double square = few::form({U_, rows, shapes}, now_, sizes_);
  if (lambda > 0.0) {
    Dozen stiffness;
    for (std::size_t j = 0; j < shapes; ++j) {
      stiffness[j] = lambda / (*V_)[static_cast<Eigen::Index>(j)];
    }
    few::stiffen(now_, stiffness, shapes);
  }
  // Without forces there is no mass.
  few::enter(now_, shapes, square > 0.0 ? std::span(passive) : std::span<const int>());
  now_.pivots = 0;
  // What is not out of place at all still carries a number in its low bits: hence the minimum.
  smallest_ = std::max(smallest_step * smallest_step * square, std::numeric_limits<double>::min());
  return true;
}

bool FewShapes::divide(int j, int other, double V1, double V2) noexcept {
  leaving_ = 0;
  const double V = V1 + V2;
  few::split(now_, {U_, *rows_, place(shapes_)},
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
  if (!fits()) return false;
  if (leaving_ != 0) few::leave(now_, place(shapes_), std::exchange(leaving_, 0U));
  return few::pivot(now_, place(shapes_), smallest_, 4 * shapes_);
}

AtPlaces FewShapes::answer() const noexcept {
  static constexpr std::array<int, few::most_shapes> numbers = {0, 1, 2, 3, 4,  5,
                                                                6, 7, 8, 9, 10, 11};
  return {&U_, now_.H.data(), numbers.data(), &now_.x, &sizes_, now_.passive};
}

bool FewShapes::none_enters(const Dozen& slopes, double threshold) noexcept {
  return few::furthest_above(now_, {U_, *rows_, place(shapes_)}, slopes, sizes_,
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
