#include "shapeid/fast/column_qr.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace shapeid::fast {
namespace {

/// A column with no more than this left is nothing: of much shorter ones the inverse of the square,
/// by which they would be reflected, overflows.
constexpr double shortest = 1e-150;

}  // namespace

// Every column adds one reflection as it enters and fewer than most_columns short ones as it
// leaves. With room for three times the columns beside their own a set is rebuilt seldom, and a new
// column never passes through many more reflections than a rebuilt set would have.
ColumnQr::ColumnQr(Eigen::Index rows, Eigen::Index most_columns)
    : rows_(rows),
      T_(Eigen::MatrixXd::Zero(most_columns, most_columns)),
      rotated_(Eigen::VectorXd::Zero(four_rows::end(rows) + four_rows::together)),
      entering_(
          Eigen::MatrixXd::Zero(four_rows::end(rows) + four_rows::together, most_columns + 1)) {
  const auto columns = static_cast<std::size_t>(most_columns);
  ends_.resize(static_cast<std::size_t>(entering_.cols()));
  wholes_.resize(ends_.size());
  reflections_.reserve(4 * columns + 4);
  vectors_.resize(2 * (columns + 1) * static_cast<std::size_t>(rows + 2 * four_rows::together) +
                  32 * columns);
}

void ColumnQr::start(const Eigen::Ref<const Eigen::VectorXd>& b) noexcept {
  size_ = 0;
  rotated_.head(rows_) = b;
  rotated_.tail(rotated_.size() - rows_).setZero();
  reflections_.clear();
  used_ = 0;
}

// What is kept of the reflections is as long as it was, so there is room.
void ColumnQr::keep(Eigen::Index columns, const Eigen::Ref<const Eigen::VectorXd>& b) noexcept {
  SHAPEID_CONTRACT(why_not_kept(columns));
  size_ = columns;
  reflections_.erase(reflections_.begin() + columns, reflections_.end());
  used_ = 0;
  if (!reflections_.empty()) {
    const RowReflection& last = reflections_.back();
    used_ = last.place + static_cast<std::size_t>(four_rows::numbers(last.first, last.end));
  }
  rotated_.head(rows_) = b;
  rotated_.tail(rotated_.size() - rows_).setZero();
  Eigen::Index rows = rows_;
  reflect_columns(reflections_.data(), reflections_.data() + columns, vectors_.data(),
                  {rotated_.data(), 0, &rows}, 1);
}

Violation ColumnQr::why_not_kept(Eigen::Index columns) const {
  if (columns > size_) return "more columns are to be kept than there are";
  if (reflections_.size() != static_cast<std::size_t>(size_)) {
    return "columns are kept of which others were removed";
  }
  return std::nullopt;
}

bool ColumnQr::has_room(std::size_t reflections, std::size_t numbers) const noexcept {
  return reflections_.size() + reflections <= reflections_.capacity() &&
         used_ + numbers <= vectors_.size();
}

ColumnQr::Push ColumnQr::push(Eigen::Index end) noexcept {
  begin(0, end);
  reflect(reflections_.data(), 0, 1);
  const Push result = take_in(0);
  if (result == Push::entered) reflect_right_side();
  return result;
}

// The right-hand side comes along behind the columns.
Eigen::Index ColumnQr::push_all(std::span<const Eigen::Index> ends) noexcept {
  const auto count = static_cast<Eigen::Index>(ends.size());
  for (Eigen::Index k = 0; k < count; ++k) begin(k, ends[static_cast<std::size_t>(k)]);
  reflect(reflections_.data(), 0, count);
  entering_.col(count) = rotated_;
  ends_[ends.size()] = rows_;
  Eigen::Index k = 0;
  for (; k < count && take_in(k) == Push::entered; ++k) {
    reflect(&reflections_.back(), k + 1, count - k);
  }
  rotated_ = entering_.col(count);
  return k;
}

void ColumnQr::begin(Eigen::Index k, Eigen::Index end) noexcept {
  double* x = entering_.col(k).data();
  std::fill(x + end, x + entering_.rows(), 0.0);
  ends_[static_cast<std::size_t>(k)] = end;
  wholes_[static_cast<std::size_t>(k)] = std::sqrt(square_of(x, 0, end));
}

void ColumnQr::reflect(const RowReflection* from, Eigen::Index k, Eigen::Index count) noexcept {
  reflect_columns(from, reflections_.data() + reflections_.size(), vectors_.data(),
                  {entering_.data() + k * entering_.rows(), entering_.rows(), ends_.data() + k},
                  count);
}

ColumnQr::Push ColumnQr::take_in(Eigen::Index k) noexcept {
  const double* x = entering_.col(k).data();
  const Eigen::Index end = ends_[static_cast<std::size_t>(k)];
  // Below row size_ stands what is new.
  const double length = end > size_ ? std::sqrt(square_of(x, size_, end)) : 0.0;
  const double whole = wholes_[static_cast<std::size_t>(k)];
  if (!(length > std::max(smallest_share * whole, shortest))) return Push::dependent;
  if (size_ == T_.cols() ||
      !has_room(1, static_cast<std::size_t>(four_rows::numbers(size_, end)))) {
    return Push::crowded;
  }
  const Eigen::Index last = size_++;
  std::copy(x, x + last, T_.col(last).data());
  T_(last, last) = append(x + last, last, end, length);
  return Push::entered;
}

/// By the last reflection.
void ColumnQr::reflect_right_side() noexcept {
  Eigen::Index rows = rows_;
  const RowReflection* last = &reflections_.back();
  reflect_columns(last, last + 1, vectors_.data(), {rotated_.data(), 0, &rows}, 1);
}

void ColumnQr::dependence(Eigen::VectorXd& x) const noexcept {
  x.head(size_) = entering_.col(0).head(size_);
  back_substitute(x);
}

bool ColumnQr::remove(Eigen::Index place) noexcept {
  const auto behind = static_cast<std::size_t>(size_ - 1 - place);
  if (!has_room(behind, 8 * behind)) return false;
  --size_;
  // Each column behind moves forward and has one number too many below the diagonal.
  for (Eigen::Index k = place; k < size_; ++k) {
    std::copy(&T_(0, k + 1), &T_(0, k + 1) + k + 2, &T_(0, k));
  }
  for (Eigen::Index k = place; k < size_; ++k) {
    const double length = std::sqrt(T_(k, k) * T_(k, k) + T_(k + 1, k) * T_(k + 1, k));
    const double image = append(&T_(k, k), k, k + 2, length);
    T_(k, k) = image;
    const RowReflection& last = reflections_.back();
    const double* v = vectors_.data() + last.place;
    for (Eigen::Index j = k + 1; j < size_; ++j) reflect_two(last, v, &T_(0, j));
    reflect_two(last, v, rotated_.data());
  }
  return true;
}

void ColumnQr::solve(Eigen::VectorXd& x) const noexcept {
  x.head(size_) = rotated_.head(size_);
  back_substitute(x);
}

void ColumnQr::solve_normal(Eigen::VectorXd& x) const noexcept {
  for (Eigen::Index k = 0; k < size_; ++k) {
    x[k] = (x[k] - T_.col(k).head(k).dot(x.head(k))) / T_(k, k);
  }
  back_substitute(x);
}

double ColumnQr::append(const double* x, Eigen::Index first, Eigen::Index end,
                        double length) noexcept {
  const double image = x[0] > 0.0 ? -length : length;
  const auto count = static_cast<std::size_t>(four_rows::numbers(first, end));
  double* all = vectors_.data() + used_;
  std::fill_n(all, count, 0.0);
  double* v = all + (first - four_rows::first(first));
  std::copy(x, x + (end - first), v);
  v[0] -= image;  // the signs differ, so that nothing cancels
  // v^T v = 2 length |v_0|
  reflections_.push_back({first, end, used_, 1.0 / (length * std::abs(v[0]))});
  used_ += count;
  return image;
}

void ColumnQr::back_substitute(Eigen::VectorXd& x) const noexcept {
  for (Eigen::Index k = size_ - 1; k >= 0; --k) {
    x[k] /= T_(k, k);
    x.head(k) -= x[k] * T_.col(k).head(k);
  }
}

}  // namespace shapeid::fast
