#include "shapeid/fast/triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

[[maybe_unused]] Violation why_other_unknowns(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.cols() == b.cols()) return std::nullopt;
  return "triangles of different unknowns do not merge";
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
    for (Eigen::Index k = 0; k < R_.cols(); ++k) annihilate(k, rows);
  }
}

void Triangle::merge(const Triangle& other) noexcept {
  SHAPEID_CONTRACT(why_other_unknowns(R_, other.R_));
  pending_ = other.R_;
  // Column k of a triangle has k + 1 rows, and reflecting these fills no others.
  for (Eigen::Index k = 0; k < R_.cols(); ++k) annihilate(k, k + 1);
}

void Triangle::clear() noexcept { R_.setZero(); }

// Householder's reflection 1 - 2 v v^T / (v^T v) of row k of R and the pending rows that makes the
// pending rows' column k zero. v = (R_kk - image, column) and v^T v = 2 length |R_kk - image|; the
// image takes the sign that R_kk does not have, so that nothing cancels.
void Triangle::annihilate(Eigen::Index k, Eigen::Index rows) noexcept {
  const auto column = pending_.col(k).head(rows);
  const double square = column.squaredNorm();
  // Shorter than 1e-154: its square is no full double, and a reflection made of it would be none.
  // It is left out, an error of its own size.
  if (square < std::numeric_limits<double>::min()) return;
  const double length = std::sqrt(R_(k, k) * R_(k, k) + square);
  const double image = R_(k, k) > 0.0 ? -length : length;
  const double top = R_(k, k) - image;
  const double half = length * std::abs(top);  // of v^T v
  R_(k, k) = image;
  for (Eigen::Index j = k + 1; j < R_.cols(); ++j) {
    auto other = pending_.col(j).head(rows);
    const double share = (top * R_(k, j) + column.dot(other)) / half;
    R_(k, j) -= share * top;
    other -= share * column;
  }
}

}  // namespace shapeid::fast
