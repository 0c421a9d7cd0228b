#include "shapeid/fast/projection.hpp"

#include <algorithm>
#include <cmath>

#include "shapeid/fast/reflections.hpp"
#include "shapeid/models/contract.hpp"

namespace shapeid::fast {
namespace {

// As in reference/projection.cpp, where the reason stands: a lever of a picometre is rounding.
constexpr double smallest_lever = 1e-12;

[[maybe_unused]] Violation why_no_weight(const Eigen::VectorXd& weight) {
  if ((weight.array() > 0.0).all() && weight.allFinite()) return std::nullopt;
  return "a weight is not positive and finite";
}

[[maybe_unused]] Violation why_other_sizes(const Eigen::Ref<const Eigen::MatrixXd>& JT,
                                           const Eigen::Ref<Eigen::MatrixXd>& rows,
                                           const Eigen::MatrixXd& A) {
  if (rows.rows() != A.rows() || JT.rows() != A.rows()) return "not a row for each weight";
  if (2 * JT.cols() > A.cols()) return "more forces than were announced";
  return std::nullopt;
}

}  // namespace

ContactElimination::ContactElimination(const Eigen::VectorXd& weight, Eigen::Index most_forces)
    : root_(weight.cwiseSqrt()),
      largest_root_(weight.size() > 0 ? root_.maxCoeff() : 0.0),
      most_forces_(most_forces),
      A_(weight.size(), 2 * most_forces),
      inverse_half_(most_forces) {
  SHAPEID_CONTRACT(why_no_weight(weight));
}

Eigen::Index ContactElimination::operator()(const Eigen::Ref<const Eigen::MatrixXd>& JT,
                                            Eigen::Ref<Eigen::MatrixXd> rows) noexcept {
  SHAPEID_CONTRACT(why_other_sizes(JT, rows, A_));
  for (Eigen::Index j = 0; j < rows.cols(); ++j) rows.col(j).array() *= root_.array();
  const Eigen::Index forces = JT.cols(), most = std::min(JT.rows(), forces);
  if (most == 0) return 0;
  auto A = A_.leftCols(forces);
  double largest = 1.0;
  for (Eigen::Index j = 0; j < forces; ++j) {
    A.col(j) = root_.cwiseProduct(JT.col(j));
    largest = std::max(largest, JT.col(j).lpNorm<Eigen::Infinity>());
  }
  const double threshold = smallest_lever * largest_root_ * largest;

  auto V = A_.rightCols(most_forces_);
  Eigen::Index rank = 0;
  for (; rank < most; ++rank) {
    const Eigen::Index left = A.rows() - rank;
    // Column pivot: what is left of the longest column.
    Eigen::Index pivot = rank;
    double square = 0.0;
    for (Eigen::Index j = rank; j < forces; ++j) {
      const double candidate = A.col(j).tail(left).squaredNorm();
      if (candidate > square) {
        square = candidate;
        pivot = j;
      }
    }
    const double length = std::sqrt(square);
    if (!(length > threshold)) break;
    // v = x - image e1, where the image takes the sign that x does not have: nothing cancels.
    auto v = V.col(rank);
    v.head(rank).setZero();
    v.tail(left) = A.col(pivot).tail(left);
    if (pivot != rank) A.col(pivot).tail(left) = A.col(rank).tail(left);
    const double image = v[rank] > 0.0 ? -length : length;
    v[rank] -= image;
    inverse_half_[rank] = 1.0 / (length * std::abs(v[rank]));
    Reflections next(v);
    next.append(inverse_half_[rank]);
    next.apply(A.rightCols(forces - rank - 1));
  }
  for (Eigen::Index first = 0; first < rank; first += Reflections::most) {
    const Eigen::Index count = std::min<Eigen::Index>(Reflections::most, rank - first);
    Reflections block(V.middleCols(first, count));
    for (Eigen::Index k = first; k < first + count; ++k) block.append(inverse_half_[k]);
    block.apply(rows);
  }
  return rank;
}

}  // namespace shapeid::fast
