#include "shapeid/fast/projection.hpp"

#include <algorithm>
#include <cmath>

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
  if (JT.cols() > A.cols()) return "more forces than were announced";
  return std::nullopt;
}

/// c becomes (1 - v v^T / half) c.
template <typename Reflector, typename Column>
void reflect(const Reflector& v, double half, Column&& c) noexcept {
  const double share = v.dot(c) / half;
  c -= share * v;
}

}  // namespace

ContactElimination::ContactElimination(const Eigen::VectorXd& weight, Eigen::Index most_forces)
    : root_(weight.cwiseSqrt()),
      largest_root_(weight.size() > 0 ? root_.maxCoeff() : 0.0),
      A_(weight.size(), most_forces) {
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

  for (Eigen::Index k = 0; k < most; ++k) {
    const Eigen::Index left = A.rows() - k;
    // Column pivot: what is left of the longest column.
    Eigen::Index pivot = k;
    double square = 0.0;
    for (Eigen::Index j = k; j < forces; ++j) {
      const double candidate = A.col(j).tail(left).squaredNorm();
      if (candidate > square) {
        square = candidate;
        pivot = j;
      }
    }
    const double length = std::sqrt(square);
    if (!(length > threshold)) return k;
    if (pivot != k) A.col(k).swap(A.col(pivot));
    // v = x - image e1, where the image takes the sign that x does not have: nothing cancels.
    auto v = A.col(k).tail(left);
    const double image = v[0] > 0.0 ? -length : length;
    v[0] -= image;
    const double half = length * std::abs(v[0]);  // of v^T v
    for (Eigen::Index j = k + 1; j < forces; ++j) reflect(v, half, A.col(j).tail(left));
    for (Eigen::Index j = 0; j < rows.cols(); ++j) reflect(v, half, rows.col(j).tail(left));
  }
  return most;
}

}  // namespace shapeid::fast
