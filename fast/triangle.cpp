#include "shapeid/fast/triangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "shapeid/models/contract.hpp"

namespace shapeid::fast {
namespace {

[[maybe_unused]] Violation why_other_sizes(const Eigen::Ref<const Eigen::MatrixXd>& Y,
                                           const Eigen::Ref<const Eigen::VectorXd>& F,
                                           const Eigen::MatrixXd& R) {
  if (Y.cols() + 1 != R.cols()) return "Y does not have a column for each unknown";
  if (Y.rows() != F.rows()) return "Y and F differ in rows";
  return std::nullopt;
}

[[maybe_unused]] Violation why_other_columns(const Eigen::Ref<Eigen::MatrixXd>& rows,
                                             const Eigen::MatrixXd& R) {
  if (rows.cols() == R.cols()) return std::nullopt;
  return "rows do not have a column for each unknown and one more";
}

[[maybe_unused]] Violation why_other_unknowns(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.cols() == b.cols()) return std::nullopt;
  return "triangles of different unknowns do not merge";
}

[[maybe_unused]] Violation why_no_factor(double factor) {
  if (factor >= 0.0 && factor <= 1.0) return std::nullopt;
  return "a forgetting factor is not between 0 and 1";
}

/// Four numbers that are worked on at once, in as many registers as the machine needs for them.
using Pack = Eigen::Array<double, 4, 1>;
using PackedHere = Eigen::Map<Pack>;
using ReadHere = Eigen::Map<const Pack>;

/// Reflects `count` columns side by side, `stride` apart, with the rows of R above them: v is read
/// once for all of them, and their sums do not wait for each other.
template <int count>
void reflect(const double* v, Eigen::Index rows, double* columns, Eigen::Index stride, double top,
             double inverse_half, double* row_of_R, Eigen::Index stride_of_R) noexcept {
  std::array<Pack, count> sums;
  sums.fill(Pack::Zero());
  const Eigen::Index packed = rows - rows % 4;
  for (Eigen::Index i = 0; i < packed; i += 4) {
    const Pack x = ReadHere(v + i);
    for (int j = 0; j < count; ++j) sums[j] += x * ReadHere(columns + j * stride + i);
  }
  std::array<double, count> shares;
  for (int j = 0; j < count; ++j) {
    double sum = sums[j].sum() + top * row_of_R[j * stride_of_R];
    for (Eigen::Index i = packed; i < rows; ++i) sum += v[i] * columns[j * stride + i];
    shares[j] = sum * inverse_half;
    row_of_R[j * stride_of_R] -= shares[j] * top;
  }
  for (Eigen::Index i = 0; i < packed; i += 4) {
    const Pack x = ReadHere(v + i);
    for (int j = 0; j < count; ++j) PackedHere(columns + j * stride + i) -= shares[j] * x;
  }
  for (Eigen::Index i = packed; i < rows; ++i) {
    for (int j = 0; j < count; ++j) columns[j * stride + i] -= shares[j] * v[i];
  }
}

}  // namespace

Triangle::Triangle(Eigen::Index unknowns)
    : R_(Eigen::MatrixXd::Zero(unknowns + 1, unknowns + 1)), pending_(unknowns + 1, unknowns + 1) {}

void Triangle::add(const Eigen::Ref<const Eigen::MatrixXd>& Y,
                   const Eigen::Ref<const Eigen::VectorXd>& F) noexcept {
  SHAPEID_CONTRACT(why_other_sizes(Y, F, R_));
  for (Eigen::Index first = 0; first < Y.rows(); first += pending_.rows()) {
    const Eigen::Index rows = std::min(pending_.rows(), Y.rows() - first);
    pending_.topLeftCorner(rows, Y.cols()) = Y.middleRows(first, rows);
    pending_.col(Y.cols()).head(rows) = F.segment(first, rows);
    absorb(pending_.topRows(rows));
  }
}

void Triangle::absorb(Eigen::Ref<Eigen::MatrixXd> rows) noexcept {
  SHAPEID_CONTRACT(why_other_columns(rows, R_));
  for (Eigen::Index k = 0; k < R_.cols(); ++k) annihilate(k, rows);
}

void Triangle::merge(const Triangle& other) noexcept {
  SHAPEID_CONTRACT(why_other_unknowns(R_, other.R_));
  pending_ = other.R_;
  // Column k of a triangle has k + 1 rows, and reflecting these fills no others.
  for (Eigen::Index k = 0; k < R_.cols(); ++k) annihilate(k, pending_.topRows(k + 1));
}

void Triangle::forget(double factor) noexcept {
  SHAPEID_CONTRACT(why_no_factor(factor));
  R_ *= std::sqrt(factor);
}

void Triangle::clear() noexcept { R_.setZero(); }

// Householder's reflection 1 - 2 v v^T / (v^T v) of row k of R and the pending rows that makes the
// pending rows' column k zero. v = (R_kk - image, column) and v^T v = 2 length |R_kk - image|; the
// image takes the sign that R_kk does not have, so that nothing cancels.
void Triangle::annihilate(Eigen::Index k, Eigen::Ref<Eigen::MatrixXd> rows) noexcept {
  const auto column = rows.col(k);
  const double square = column.squaredNorm();
  // Shorter than 1e-154: its square is no full double, and a reflection made of it would be none.
  // It is left out, an error of its own size.
  if (square < std::numeric_limits<double>::min()) return;
  const double length = std::sqrt(R_(k, k) * R_(k, k) + square);
  const double image = R_(k, k) > 0.0 ? -length : length;
  const double top = R_(k, k) - image;
  const double inverse_half = 1.0 / (length * std::abs(top));  // of v^T v
  R_(k, k) = image;
  const Eigen::Index n = R_.cols(), stride = rows.outerStride();
  const auto reflect_from = [&]<int count>(Eigen::Index j, std::integral_constant<int, count>) {
    reflect<count>(&rows.coeffRef(0, k), rows.rows(), &rows.coeffRef(0, j), stride, top,
                   inverse_half, &R_.coeffRef(k, j), n);
  };
  Eigen::Index j = k + 1;
  for (; j + 4 <= n; j += 4) reflect_from(j, std::integral_constant<int, 4>());
  for (; j < n; ++j) reflect_from(j, std::integral_constant<int, 1>());
}

}  // namespace shapeid::fast
