#include "shapeid/fast/six_rows.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "shapeid/fast/regressor.hpp"
#include "shapeid/models/contract.hpp"

namespace shapeid::fast {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

// |J_s|^3 / |det J_s|, which is 6 to 35 for legs as they walk. So many roundings may be in J_s^-1
// by cofactors: beyond a thousand, a fast answer would be worth fewer than twelve digits.
constexpr double most_singular_leg = 1e3;

// Bound of || H ||_F^2 + 1, the condition of the six rows' covariance 1 + H H^T, for the same
// reason.
constexpr double largest_condition = 1e4;

[[maybe_unused]] Violation why_not_for(const Robot& robot, const Eigen::VectorXd& weight) {
  if (robot.root != Root::floating) return "six rows are of a floating base";
  if (weight.size() != robot.dof()) return "not a weight for each row";
  if (!(weight.array() > 0.0).all() || !weight.allFinite()) return "a weight is not positive";
  return std::nullopt;
}

/// M = L D L^T, which has no eigenvalue below one. T becomes T L^-T, and 1 / D is left on M's
/// diagonal. Without the square roots of Cholesky each column waits for one division only.
template <int k = 0>
void eliminate(Matrix6d& M, Eigen::Matrix<double, 12, 6>& T) noexcept {
  constexpr int left = 5 - k;
  M(k, k) = 1.0 / M(k, k);
  if constexpr (left > 0) {
    const Eigen::Matrix<double, left, 1> column = M.col(k).template tail<left>();
    const Eigen::Matrix<double, left, 1> l = column * M(k, k);
    M.template bottomRightCorner<left, left>().noalias() -= l * column.transpose();
    T.template rightCols<left>().noalias() -= T.col(k) * l.transpose();
    eliminate<k + 1>(M, T);
  }
}

}  // namespace

SixRows::SixRows(const Robot& robot, const Eigen::VectorXd& weight)
    : weight_(weight),
      root_(weight.cwiseSqrt()),
      inverse_root_(root_.cwiseInverse()),
      standing_(robot.links.size()) {
  SHAPEID_CONTRACT(why_malformed(robot));
  SHAPEID_CONTRACT(why_not_for(robot, weight));
  for (const Contact& contact : robot.contacts) {
    Leg leg;
    leg.foot = contact.frame.translation();
    int count = 0;
    for (int i = contact.link; i != 0; i = robot.links[static_cast<std::size_t>(i)].parent) {
      if (count < 3) leg.links[static_cast<std::size_t>(count)] = i;
      ++count;
    }
    leg.stands_alone = contact.kind == ContactKind::point && count == 3;
    legs_.push_back(leg);
  }
}

bool SixRows::operator()(Kinematics& kinematics, const std::vector<bool>& in_contact,
                         const Eigen::VectorXd& F, Rows& rows) noexcept {
  std::fill(standing_.begin(), standing_.end(), false);
  Vector6d base_F = F.head<6>();
  Matrix6d M = Matrix6d::Identity();  // 1 + H H^T
  double condition = 1.0;
  for (std::size_t c = 0; c < in_contact.size(); ++c) {
    if (!in_contact[c]) continue;
    const Leg& leg = legs_[c];
    if (!leg.stands_alone) return false;
    const LinkPose& last = kinematics.pose(leg.links[0]);
    const Vector3d foot = last.R * leg.foot + last.p;
    Matrix3d J;  // J_s
    for (int i = 0; i < 3; ++i) {
      const int link = leg.links[static_cast<std::size_t>(i)];
      if (standing_[static_cast<std::size_t>(link)]) return false;  // another foot's as well
      standing_[static_cast<std::size_t>(link)] = true;
      const Vector3d z = kinematics.axis_in_base(link);
      J.col(i) = kinematics.slides(link) ? z : z.cross(foot - kinematics.pose(link).p);
    }
    Matrix3d N;  // cofactors, then J_s^-T
    N << J.col(1).cross(J.col(2)), J.col(2).cross(J.col(0)), J.col(0).cross(J.col(1));
    const double determinant = J.col(0).dot(N.col(0)), square = J.squaredNorm();
    if (!(most_singular_leg * std::abs(determinant) > square * std::sqrt(square))) return false;
    N *= 1.0 / determinant;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Index joint = 5 + leg.links[static_cast<std::size_t>(i)];
      Vector6d g;  // column of G = J_b^T J_s^-T: the base's wrench for each unit of torque
      g << N.col(i), foot.cross(N.col(i));
      base_F -= g * F[joint];
      const Vector6d h = root_.head<6>().cwiseProduct(g) * inverse_root_[joint];
      condition += h.squaredNorm();
      M.noalias() += h * h.transpose();
    }
  }
  if (!(condition < largest_condition)) return false;

  // A row of zeros makes columns of whole registers.
  Eigen::Matrix<double, 12, 6> T;
  T.topRows<10>().noalias() = body_wrench(kinematics.motion(0)) * root_.head<6>().asDiagonal();
  T.row(10) = base_F.cwiseProduct(root_.head<6>()).transpose();
  T.row(11).setZero();
  eliminate(M, T);
  for (int i = 0; i < 6; ++i) rows.transposed.col(i) = T.col(i).head<11>() * std::sqrt(M(i, i));
  rows.constant = 0.0;
  for (std::size_t link = 1; link < standing_.size(); ++link) {
    if (standing_[link]) continue;
    const auto joint = static_cast<Eigen::Index>(5 + link);
    rows.constant += weight_[joint] * F[joint] * F[joint];
  }
  return true;
}

}  // namespace shapeid::fast
