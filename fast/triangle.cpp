#include "shapeid/fast/triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shapeid/fast/reflections.hpp"
#include "shapeid/models/contract.hpp"

namespace shapeid::fast {
namespace {

// From here on columns no longer stay in the nearest cache from one reflection to the next, and
// several reflections at once are faster; below, making a block of them costs more than it saves.
constexpr Eigen::Index many_unknowns = 30;

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
  return "triangles of different unknowns";
}

[[maybe_unused]] Violation why_no_factor(double factor) {
  if (factor >= 0.0 && factor <= 1.0) return std::nullopt;
  return "a forgetting factor is not between 0 and 1";
}

}  // namespace

Triangle::Triangle(Eigen::Index unknowns)
    : at_once_(unknowns < many_unknowns ? 1 : Reflections::most),
      R_(Eigen::MatrixXd::Zero(unknowns + 1, unknowns + 1)),
      pending_(unknowns + 1, unknowns + 1) {}

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
  for (Eigen::Index k = 0; k < R_.cols(); k += at_once_) annihilate(k, rows);
}

void Triangle::merge(const Triangle& other) noexcept {
  SHAPEID_CONTRACT(why_other_unknowns(R_, other.R_));
  pending_ = other.R_;
  for (Eigen::Index k = 0; k < R_.cols(); k += at_once_) {
    // The columns of a triangle up to number k have k + 1 rows, and reflecting these fills no
    // others.
    Eigen::Ref<Eigen::MatrixXd> rows = pending_.topRows(std::min(k + at_once_, R_.cols()));
    annihilate(k, rows);
  }
}

void Triangle::assign(const Triangle& other) noexcept {
  SHAPEID_CONTRACT(why_other_unknowns(R_, other.R_));
  R_ = other.R_;
}

void Triangle::forget(double factor) noexcept {
  SHAPEID_CONTRACT(why_no_factor(factor));
  R_ *= std::sqrt(factor);
}

void Triangle::clear() noexcept { R_.setZero(); }

// Makes the rows' columns from `first` on zero, as many as are reflected together. Householder's
// reflection 1 - x x^T / half of row k of R and all rows makes column k zero: x = (R_kk - image,
// column) and half = length |R_kk - image|; the image takes the sign that R_kk does not have, so
// that nothing cancels.
void Triangle::annihilate(Eigen::Index first, Eigen::Ref<Eigen::MatrixXd>& rows) noexcept {
  const Eigen::Index end = std::min(first + at_once_, R_.cols());
  Reflections block(rows.middleCols(first, end - first));
  for (Eigen::Index k = first; k < end; ++k) {
    const auto column = rows.col(k);
    // The earlier ones of the block have already been applied to this column.
    const double square = column.squaredNorm();
    // Shorter than 1e-154: its square is no full double, and a reflection made of it would be none.
    // It is left out, an error of its own size.
    double top = 0.0, inverse_half = 0.0;
    if (!(square < std::numeric_limits<double>::min())) {
      const double length = std::sqrt(R_(k, k) * R_(k, k) + square);
      const double image = R_(k, k) > 0.0 ? -length : length;
      top = R_(k, k) - image;
      inverse_half = 1.0 / (length * std::abs(top));
      R_(k, k) = image;
    }
    if (const Eigen::Index left = end - k - 1; left > 0) {
      Reflections alone(column);
      alone.append(top, inverse_half);
      alone.apply(rows.middleCols(k + 1, left), R_.block(k, k + 1, 1, left));
    }
    block.append(top, inverse_half);
  }
  const Eigen::Index left = R_.cols() - end;
  block.apply(rows.rightCols(left), R_.block(first, end, end - first, left));
}

}  // namespace shapeid::fast
