#include "shapeid/reference/projection.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>

namespace shapeid::reference {
namespace {

// Pivots below this are rounding. They carry the unit of J (1, or m of lever arm) times W^(1/2).
// A picometre is a thousand times what rounding leaves of a lever arm that should be zero (metres
// x eps x the links of the chain), and a thousand newton on it are still nothing to a torque
// sensor; no joint position is known well enough to tell it from a singularity.
constexpr double smallest_lever = 1e-12;

}  // namespace

Violation why_no_weight(const Eigen::VectorXd& weight, Eigen::Index rows) {
  if (weight.size() != rows) return fmt::format("{} weights for {} rows", weight.size(), rows);
  const bool positive = (weight.array() > 0.0).all() && weight.allFinite();
  if (!positive) return "a weight is not positive and finite";
  return std::nullopt;
}

ContactFreeBasis contact_free_basis(const Eigen::MatrixXd& J, const Eigen::VectorXd& weight) {
  SHAPEID_CONTRACT(why_no_weight(weight, J.cols()));
  const Eigen::Index rows = weight.size();
  if (J.size() == 0) return {Eigen::MatrixXd::Identity(rows, rows), 0};

  const Eigen::VectorXd root = weight.cwiseSqrt();
  // (7), (8): W^(1/2) J^T P = [Q1 Q2] [R; 0]; column pivots put the independent columns first.
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(root.asDiagonal() * J.transpose());
  const Eigen::VectorXd pivots = qr.matrixR().diagonal().cwiseAbs();
  const double scale = root.maxCoeff() * std::max(1.0, J.cwiseAbs().maxCoeff());
  const Eigen::Index rank = (pivots.array() > smallest_lever * scale).count();
  const Eigen::MatrixXd Q = qr.householderQ();
  return {Q.rightCols(rows - rank), static_cast<int>(rank)};
}

ContactFreeRows eliminate_contacts(const Eigen::MatrixXd& Y, const Eigen::VectorXd& F,
                                   const Eigen::MatrixXd& J, const Eigen::VectorXd& weight) {
  const auto [Q2, rank] = contact_free_basis(J, weight);
  const Eigen::MatrixXd projector = Q2.transpose() * weight.cwiseSqrt().asDiagonal();
  return {projector * Y, projector * F, rank};  // (9)
}

}  // namespace shapeid::reference
