#include "shapeid/fast/regressor.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "shapeid/models/contract.hpp"

namespace shapeid::fast {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

[[maybe_unused]] Violation why_unknown_link(const Robot& robot, const std::vector<int>& links) {
  for (const int link : links) {
    if (link < 0 || link >= robot.link_count()) {
      return "link " + std::to_string(link) + " is wanted of a robot that has " +
             std::to_string(robot.link_count());
    }
  }
  return std::nullopt;
}

[[maybe_unused]] Violation why_other_joints(const Sample& sample, Eigen::Index joints) {
  if (sample.q.size() == joints && sample.dq.size() == joints && sample.ddq.size() == joints) {
    return std::nullopt;
  }
  return "q, dq or ddq does not have an entry for each of " + std::to_string(joints) + " joints";
}

/// Which links stand on the way from the root to a wanted one, the root and the wanted included.
std::vector<bool> on_the_way(const Robot& robot, const std::vector<int>& wanted) {
  std::vector<bool> needed(robot.links.size(), false);
  needed.front() = true;
  for (int link : wanted) {
    while (!needed[static_cast<std::size_t>(link)]) {
      needed[static_cast<std::size_t>(link)] = true;
      link = robot.links[static_cast<std::size_t>(link)].parent;
    }
  }
  return needed;
}

/// A motion's force and moment about the link origin, in base axes, for each of the ten parameters.
/// The tensor takes no force.
struct Wrench {
  Eigen::Matrix<double, 3, 4> force;
  Eigen::Matrix<double, 3, 10> moment;
};

/// S(alpha) + S(omega) S(omega): what a first moment h is multiplied by to give a force.
Matrix3d force_of_moment(const Vector3d& omega, const Vector3d& alpha) {
  const double x = omega.x(), y = omega.y(), z = omega.z();
  Matrix3d K;
  K << -y * y - z * z, x * y - alpha.z(), x * z + alpha.y(),  //
      x * y + alpha.z(), -x * x - z * z, y * z - alpha.x(),   //
      x * z - alpha.y(), y * z + alpha.x(), -x * x - y * y;
  return K;
}

/// L(alpha) + S(omega) L(omega): what (Ixx, Ixy, Ixz, Iyy, Iyz, Izz) are multiplied by to give
/// I alpha + omega x (I omega).
Eigen::Matrix<double, 3, 6> moment_of_tensor(const Vector3d& omega, const Vector3d& alpha) {
  const double x = omega.x(), y = omega.y(), z = omega.z();
  const double ax = alpha.x(), ay = alpha.y(), az = alpha.z();
  Eigen::Matrix<double, 3, 6> L;
  L << ax, ay - x * z, az + x * y, -y * z, y * y - z * z, y * z,  //
      x * z, ax + y * z, z * z - x * x, ay, az - x * y, -x * z,   //
      -x * y, x * x - y * y, ax - y * z, x * y, ay + x * z, az;
  return L;
}

/// Equation (2). A tensor is given in link axes and so is multiplied there; the rest is done in
/// base axes.
Wrench body_wrench(const Matrix3d& R, const Vector3d& omega, const Vector3d& alpha,
                   const Vector3d& a) {
  Wrench w;
  w.force.col(0) = a;
  w.force.rightCols<3>().noalias() = force_of_moment(omega, alpha) * R;
  w.moment.col(0).setZero();
  for (int k = 0; k < 3; ++k) w.moment.col(1 + k) = R.col(k).cross(a);
  w.moment.rightCols<6>().noalias() =
      R * moment_of_tensor(R.transpose() * omega, R.transpose() * alpha);
  return w;
}

}  // namespace

Regressor::Regressor(const Robot& robot, const std::vector<int>& links)
    : joints_(robot.joint_count()), base_dof_(robot.base_dof()) {
  SHAPEID_CONTRACT(why_malformed(robot));
  SHAPEID_CONTRACT(why_unknown_link(robot, links));
  const std::vector<bool> needed = on_the_way(robot, links);
  std::vector<int> place(robot.links.size(), 0);
  carried_.emplace_back();  // the root
  for (int i = 1; i < robot.link_count(); ++i) {
    if (!needed[static_cast<std::size_t>(i)]) continue;
    const Link& link = robot.links[static_cast<std::size_t>(i)];
    const Vector3d& axis = link.joint.axis;
    const Matrix3d P = link.joint.placement.linear();

    Carried carried;
    carried.parent = place[static_cast<std::size_t>(link.parent)];
    carried.joint = i - 1;
    carried.slides = link.joint.kind == JointKind::prismatic;
    carried.axis = axis;
    carried.origin = link.joint.placement.translation();
    if (carried.slides) {
      carried.still = P;
      carried.even.setZero();
      carried.odd.setZero();
    } else {
      const Matrix3d along = axis * axis.transpose();
      carried.still = P * along;
      carried.even = P * (Matrix3d::Identity() - along);
      for (int k = 0; k < 3; ++k) carried.odd.col(k) = P * axis.cross(Vector3d::Unit(k));
    }
    place[static_cast<std::size_t>(i)] = static_cast<int>(carried_.size());
    carried_.push_back(carried);
  }
  for (const int link : links) wanted_.push_back(place[static_cast<std::size_t>(link)]);
  motions_.resize(carried_.size());
  Y_.setZero(robot.dof(), 10 * static_cast<Eigen::Index>(links.size()));
}

const Eigen::MatrixXd& Regressor::operator()(const Sample& sample) noexcept {
  SHAPEID_CONTRACT(why_other_joints(sample, joints_));
  motions_.front() = {Matrix3d::Identity(),         Vector3d::Zero(),
                      sample.base_angular_velocity, sample.base_angular_acceleration,
                      sample.base_specific_force,   Vector3d::Zero()};
  for (std::size_t i = 1; i < carried_.size(); ++i) {
    const Carried& link = carried_[i];
    motions_[i] = moved_by(motions_[static_cast<std::size_t>(link.parent)], link, sample);
  }
  Eigen::Index column = 0;
  for (const int place : wanted_) {
    write_columns(place, column);
    column += 10;
  }
  return Y_;
}

Regressor::Motion Regressor::moved_by(const Motion& parent, const Carried& link,
                                      const Sample& sample) noexcept {
  const double q = sample.q[link.joint], dq = sample.dq[link.joint], ddq = sample.ddq[link.joint];
  Motion m;
  Vector3d r = parent.R * link.origin;  // from the parent's origin to the link's
  if (link.slides) {
    m.R.noalias() = parent.R * link.still;
    m.z = m.R * link.axis;
    r += q * m.z;
  } else {
    const Matrix3d turned = link.still + std::cos(q) * link.even + std::sin(q) * link.odd;
    m.R.noalias() = parent.R * turned;
    m.z = m.R * link.axis;
  }
  m.p = parent.p + r;
  m.omega = parent.omega;
  m.alpha = parent.alpha;
  m.a = parent.a + parent.alpha.cross(r) + parent.omega.cross(parent.omega.cross(r));
  const Vector3d turning = parent.omega.cross(m.z) * dq;  // of the moving axis
  if (link.slides) {
    m.a += m.z * ddq + 2.0 * turning;
  } else {
    m.omega += m.z * dq;
    m.alpha += m.z * ddq + turning;
  }
  return m;
}

// Equation (3): in each generalised direction the wrench counts by the velocity that this direction
// gives the link. The zeros that the constructor wrote are left alone: joints that do not carry the
// link, and the tensor's share of forces.
void Regressor::write_columns(int place, Eigen::Index first_column) noexcept {
  const Motion& link = motions_[static_cast<std::size_t>(place)];
  const Wrench w = body_wrench(link.R, link.omega, link.alpha, link.a);
  auto Y = Y_.middleCols<10>(first_column);
  if (base_dof_ != 0) {
    Y.topLeftCorner<3, 4>() = w.force;
    Y.middleRows<3>(3) = w.moment;
    for (int k = 0; k < 4; ++k) Y.block<3, 1>(3, k) += link.p.cross(w.force.col(k));
  }
  for (int i = place; i != 0; i = carried_[static_cast<std::size_t>(i)].parent) {
    const Carried& carried = carried_[static_cast<std::size_t>(i)];
    const Motion& joint = motions_[static_cast<std::size_t>(i)];
    auto row = Y.row(base_dof_ + carried.joint);
    if (carried.slides) {
      row.head<4>().noalias() = joint.z.transpose() * w.force;
    } else {
      const Vector3d lever = joint.z.cross(link.p - joint.p);
      row.noalias() = joint.z.transpose() * w.moment;
      row.head<4>().noalias() += lever.transpose() * w.force;
    }
  }
}

}  // namespace shapeid::fast
