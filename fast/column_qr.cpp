#include "shapeid/fast/column_qr.hpp"

#include <algorithm>
#include <cmath>

namespace shapeid::fast {
namespace {

/// Vectors here are short: four numbers at a time, without a look at where they begin in memory.
constexpr Eigen::Index together = 4;
using Four = Eigen::Map<Eigen::Array<double, together, 1>>;
using ConstFour = Eigen::Map<const Eigen::Array<double, together, 1>>;

double dot(const double* a, const double* b, Eigen::Index n) noexcept {
  Eigen::Array<double, together, 1> sums = Eigen::Array<double, together, 1>::Zero();
  Eigen::Index i = 0;
  for (; i + together <= n; i += together) sums += ConstFour(a + i) * ConstFour(b + i);
  double sum = sums.sum();
  for (; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

/// y -= share x
void take_away(double share, const double* x, double* y, Eigen::Index n) noexcept {
  Eigen::Index i = 0;
  for (; i + together <= n; i += together) Four(y + i) -= share * ConstFour(x + i);
  for (; i < n; ++i) y[i] -= share * x[i];
}

}  // namespace

// Every column adds one reflection as it enters and fewer than most_columns short ones as it
// leaves. With room for three times the columns a set is rebuilt seldom, and a new column never
// passes through many more reflections than a rebuilt set would have.
ColumnQr::ColumnQr(Eigen::Index rows, Eigen::Index most_columns)
    : T_(Eigen::MatrixXd::Zero(most_columns, most_columns)),
      rotated_(Eigen::VectorXd::Zero(rows)),
      entering_(Eigen::VectorXd::Zero(rows)) {
  const auto columns = static_cast<std::size_t>(most_columns);
  reflections_.reserve(4 * columns + 4);
  vectors_.resize(2 * (columns + 1) * static_cast<std::size_t>(rows) + 8 * columns);
}

void ColumnQr::start(const Eigen::Ref<const Eigen::VectorXd>& b) noexcept {
  size_ = 0;
  rotated_ = b;
  reflections_.clear();
  used_ = 0;
}

bool ColumnQr::has_room(std::size_t reflections, std::size_t numbers) const noexcept {
  return reflections_.size() + reflections <= reflections_.capacity() &&
         used_ + numbers <= vectors_.size();
}

ColumnQr::Push ColumnQr::push(Eigen::Index end) noexcept {
  double* x = entering_.data();
  std::fill(x + end, x + entering_.size(), 0.0);
  const double whole = std::sqrt(dot(x, x, end));
  for (const Reflection& r : reflections_) {
    if (r.first >= end) continue;  // meets zeros only
    apply(r, x);
    end = std::max(end, r.end);
  }
  // Below row size_ stands what is new.
  const double length = end > size_ ? std::sqrt(dot(x + size_, x + size_, end - size_)) : 0.0;
  if (!(length > smallest_share * whole)) return Push::dependent;
  if (size_ == T_.cols() || !has_room(1, static_cast<std::size_t>(end - size_))) {
    return Push::crowded;
  }
  const Eigen::Index k = size_++;
  std::copy(x, x + k, T_.col(k).data());
  T_(k, k) = append(x + k, k, end, length);
  apply(reflections_.back(), rotated_.data());
  return Push::entered;
}

void ColumnQr::dependence(Eigen::VectorXd& x) const noexcept {
  x.head(size_) = entering_.head(size_);
  back_substitute(x);
}

bool ColumnQr::remove(Eigen::Index place) noexcept {
  const auto behind = static_cast<std::size_t>(size_ - 1 - place);
  if (!has_room(behind, 2 * behind)) return false;
  --size_;
  // Each column behind moves forward and has one number too many below the diagonal.
  for (Eigen::Index k = place; k < size_; ++k) {
    std::copy(&T_(0, k + 1), &T_(0, k + 1) + k + 2, &T_(0, k));
  }
  for (Eigen::Index k = place; k < size_; ++k) {
    const double length = std::sqrt(T_(k, k) * T_(k, k) + T_(k + 1, k) * T_(k + 1, k));
    const double image = append(&T_(k, k), k, k + 2, length);
    T_(k, k) = image;
    for (Eigen::Index j = k + 1; j < size_; ++j) apply(reflections_.back(), &T_(0, j));
    apply(reflections_.back(), rotated_.data());
  }
  return true;
}

void ColumnQr::solve(Eigen::VectorXd& x) const noexcept {
  x.head(size_) = rotated_.head(size_);
  back_substitute(x);
}

void ColumnQr::solve_normal(Eigen::VectorXd& x) const noexcept {
  for (Eigen::Index k = 0; k < size_; ++k) {
    x[k] = (x[k] - dot(&T_(0, k), x.data(), k)) / T_(k, k);
  }
  back_substitute(x);
}

double ColumnQr::append(const double* x, Eigen::Index first, Eigen::Index end,
                        double length) noexcept {
  const double image = x[0] > 0.0 ? -length : length;
  double* v = vectors_.data() + used_;
  std::copy(x, x + (end - first), v);
  v[0] -= image;  // the signs differ, so that nothing cancels
  // v^T v = 2 length |v_0|
  reflections_.push_back({first, end, used_, 1.0 / (length * std::abs(v[0]))});
  used_ += static_cast<std::size_t>(end - first);
  return image;
}

void ColumnQr::apply(const Reflection& r, double* x) const noexcept {
  const double* v = vectors_.data() + r.place;
  double* y = x + r.first;
  const Eigen::Index n = r.end - r.first;
  const double share = r.scale * dot(v, y, n);
  take_away(share, v, y, n);
}

void ColumnQr::back_substitute(Eigen::VectorXd& x) const noexcept {
  for (Eigen::Index k = size_ - 1; k >= 0; --k) {
    x[k] /= T_(k, k);
    take_away(x[k], &T_(0, k), x.data(), k);
  }
}

}  // namespace shapeid::fast
