#include "shapeid/fast/one_link.hpp"

#include <cmath>
#include <cstddef>

#include "shapeid/fast/column_qr.hpp"

namespace shapeid::fast {

OneLink::OneLink(const ShapeColumns& columns)
    : columns_(&columns),
      target_(Eigen::VectorXd::Zero(10)),
      slopes_(Eigen::VectorXd::Zero(10)),
      correction_(Eigen::VectorXd::Zero(10)) {
  rows_.setZero();
  inverse_.setZero();
}

void OneLink::start(const Eigen::MatrixXd& R) noexcept {
  size_ = 0;
  rows_.leftCols<11>() = R.topRows<10>();
  inverse_.setZero();
  target_.setZero();
  Row g = Row::Zero();
  for (int i = 0; i < 10; ++i) g.noalias() += rows_(i, 10) * rows_.row(i);
  slopes_ = g.head<10>().transpose();
}

// Householder's reflection of rows size_ and below. With w the part of the column in these rows,
// s = w^T rows and t = ||w||: the new row size_ is -+ s / t, so the slopes fall by s s_c / t^2 with
// s_c the entry of the right-hand side. That needs no square root, and pricing need not wait for
// one.
bool OneLink::enter(int j) noexcept {
  const int k = size_;
  if (k == 10) {
    refused_.noalias() = rows_.leftCols<10>() * columns_->column(j);
    return false;
  }
  Eigen::Map<Vector10> slopes(slopes_.data()), target(target_.data());
  const Vector10 u = columns_->column(j);
  Vector10 w;
  for (int i = 0; i < 10; ++i) w[i] = rows_.row(i).head<10>().dot(u);
  Vector10 tail = w;
  for (int i = 0; i < k; ++i) tail[i] = 0.0;
  const double square = tail.squaredNorm();
  if (!(square > ColumnQr::smallest_share * ColumnQr::smallest_share * w.squaredNorm())) {
    refused_ = w;
    return false;
  }
  Row s = Row::Zero();
  for (int i = k; i < 10; ++i) s.noalias() += w[i] * rows_.row(i);
  slopes -= (s[10] / square) * s.head<10>().transpose();

  const double length = std::sqrt(square), inverse_length = 1.0 / length;
  const double image = w[k] > 0.0 ? -length : length;
  const double inverse_image = w[k] > 0.0 ? -inverse_length : inverse_length;
  // T gains the column (w_0 ... w_(k-1), image), so its inverse gains -T^-1 w / image, 1 / image.
  Vector10 column = Vector10::Zero();
  for (int i = 0; i < k; ++i) column.noalias() -= w[i] * inverse_.col(i);
  column *= inverse_image;
  column[k] = inverse_image;
  inverse_.col(k) = column;
  target += (s[10] * inverse_image) * column;

  s = (inverse_length / (length + std::abs(w[k]))) * (s - image * rows_.row(k));
  w[k] -= image;  // the signs differ, so that nothing cancels
  for (int i = k; i < 10; ++i) rows_.row(i).noalias() -= w[i] * s;
  passive_[static_cast<std::size_t>(k)] = j;
  if (++size_ == 10) slopes.setZero();  // no row is left that a slope could come from
  return true;
}

void OneLink::dependence(Eigen::VectorXd& coefficients) noexcept {
  coefficients.head(size_).noalias() =
      inverse_.topLeftCorner(size_, size_).triangularView<Eigen::Upper>() * refused_.head(size_);
}

// Rotations of neighbouring rows of Q^T [R c], and of columns of T^-1, that gather row `place` of
// T^-1 in its last column. Without that row and column it is the inverse of the triangle that is
// left.
void OneLink::leave(int place) noexcept {
  const int k = --size_;
  for (int i = place; i < k; ++i) {
    const double a = inverse_(place, i + 1), b = inverse_(place, i);
    const double scale = 1.0 / std::sqrt(a * a + b * b), c = a * scale, s = b * scale;
    const Vector10 left = inverse_.col(i), right = inverse_.col(i + 1);
    inverse_.col(i) = c * left - s * right;
    inverse_.col(i + 1) = c * right + s * left;
    const Row upper = rows_.row(i), lower = rows_.row(i + 1);
    rows_.row(i) = c * upper - s * lower;
    rows_.row(i + 1) = c * lower + s * upper;
  }
  Eigen::Map<Vector10> slopes(slopes_.data()), target(target_.data());
  slopes += rows_(k, 10) * rows_.row(k).head<10>().transpose();
  target -= rows_(k, 10) * inverse_.col(k);
  inverse_.col(k).setZero();
  for (int i = place; i < k; ++i) {
    passive_[static_cast<std::size_t>(i)] = passive_[static_cast<std::size_t>(i) + 1];
    inverse_.row(i) = inverse_.row(i + 1);
    target[i] = target[i + 1];
  }
  inverse_.row(k).setZero();
  target[k] = 0.0;
}

// T^T T z = x by the inverse of T.
void OneLink::solve_normal(Eigen::VectorXd& x) noexcept {
  Vector10 y = Vector10::Zero();
  for (int i = 0; i < size_; ++i) y += x[i] * inverse_.row(i).transpose();  // becomes T^-T x
  const Vector10 z = inverse_ * y;
  x.head(size_) = z.head(size_);
}

// The normal equations of the correction, A^T A x = A^T r.
void OneLink::refine(const Eigen::VectorXd& slopes) noexcept {
  for (int i = 0; i < size_; ++i) {
    correction_[i] = columns_->column(passive_[static_cast<std::size_t>(i)]).dot(slopes);
  }
  solve_normal(correction_);
  target_.head(size_) += correction_.head(size_);
}

}  // namespace shapeid::fast
