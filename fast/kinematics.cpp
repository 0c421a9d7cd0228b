#include "shapeid/fast/kinematics.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <string>

#include "shapeid/models/contract.hpp"

namespace shapeid::fast {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

[[maybe_unused]] Violation why_other_joints(const Sample& sample, Eigen::Index joints) {
  if (sample.q.size() == joints && sample.dq.size() == joints && sample.ddq.size() == joints) {
    return std::nullopt;
  }
  return "q, dq or ddq does not have an entry for each of " + std::to_string(joints) + " joints";
}

/// S(alpha) + S(omega) S(omega)
Matrix3d acceleration_field(const Vector3d& omega, const Vector3d& alpha) noexcept {
  const double x = omega.x(), y = omega.y(), z = omega.z();
  const double xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z;
  Matrix3d K;
  K << -yy - zz, xy - alpha.z(), xz + alpha.y(),  //
      xy + alpha.z(), -xx - zz, yz - alpha.x(),   //
      xz - alpha.y(), yz + alpha.x(), -xx - yy;
  return K;
}

}  // namespace

Kinematics::Kinematics(const Robot& robot)
    : base_dof_(robot.base_dof()), links_(robot.links.size()) {
  SHAPEID_CONTRACT(why_malformed(robot));
  links_.front().pose = {Matrix3d::Identity(), Vector3d::Zero()};
  for (std::size_t i = 1; i < links_.size(); ++i) {
    const Joint& joint = robot.links[i].joint;
    const Matrix3d P = joint.placement.linear();
    const Matrix3d along = joint.axis * joint.axis.transpose();
    Link& link = links_[i];
    link.parent = robot.links[i].parent;
    link.slides = joint.kind == JointKind::prismatic;
    link.axis = joint.axis;
    link.origin = link.arm = joint.placement.translation();
    link.slide = link.slides ? Vector3d(P * joint.axis) : Vector3d::Zero();
    if (P.isIdentity(0.0)) {
      if (link.slides) link.about = 0;  // by no angle
      for (int k = 0; !link.slides && k < 3; ++k) {
        if (link.axis.cwiseAbs() == Vector3d::Unit(k)) link.about = k;
      }
    }
    link.sense = link.about != any && !link.slides ? link.axis[link.about] : 1.0;
    link.even = link.odd = Matrix3d::Zero();
    if (link.slides) {
      link.still = P;
    } else {
      link.still = P * along;
      link.even = P * (Matrix3d::Identity() - along);
      for (int k = 0; k < 3; ++k) link.odd.col(k) = P * link.axis.cross(Vector3d::Unit(k));
    }
    link.turn = link.still;
  }
}

void Kinematics::start(const Sample& sample) noexcept {
  SHAPEID_CONTRACT(why_other_joints(sample, link_count() - 1));
  sample_ = &sample;
  ++sample_number_;
  Link& root = links_.front();
  const Vector3d &omega = sample.base_angular_velocity, &alpha = sample.base_angular_acceleration;
  root.motion = {omega, alpha, sample.base_specific_force, acceleration_field(omega, alpha)};
  root.moved_in = root.posed_in = sample_number_;
}

void Kinematics::turn(int number) noexcept {
  Link& link = links_[static_cast<std::size_t>(number)];
  if (link.turned_in == sample_number_) return;
  link.turned_in = sample_number_;
  const double q = sample_->q[number - 1];
  if (link.slides) {
    link.arm = link.origin + q * link.slide;
    return;
  }
  link.cosine = std::cos(q);
  link.sine = link.sense * std::sin(q);
  if (link.about == any) link.turn = link.still + link.cosine * link.even + link.sine * link.odd;
}

// The parent's motion at the joint, plus what the joint adds.
const LinkMotion& Kinematics::move(int number) noexcept {
  Link& link = links_[static_cast<std::size_t>(number)];
  const LinkMotion& parent = motion(link.parent);
  turn(number);
  link.moved_in = sample_number_;
  const double dq = sample_->dq[number - 1], ddq = sample_->ddq[number - 1];
  LinkMotion& m = link.motion;
  m.omega = link.down(parent.omega);
  m.alpha = link.down(parent.alpha);
  m.a = link.down(parent.a + parent.K * link.arm);
  const Vector3d along = link.axis * dq;
  const Vector3d turning = m.omega.cross(along);  // of the axis, which the parent carries
  if (link.slides) {
    m.a += link.axis * ddq + 2.0 * turning;
  } else {
    m.omega += along;
    m.alpha += link.axis * ddq + turning;
  }
  m.K = acceleration_field(m.omega, m.alpha);
  return m;
}

const LinkPose& Kinematics::place(int number) noexcept {
  Link& link = links_[static_cast<std::size_t>(number)];
  const LinkPose& parent = pose(link.parent);
  turn(number);
  link.posed_in = sample_number_;
  if (link.about == any) {
    link.pose.R.noalias() = parent.R * link.turn;
  } else {
    const int k = link.about, i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    link.pose.R.col(k) = parent.R.col(k);
    link.pose.R.col(i) = link.cosine * parent.R.col(i) + link.sine * parent.R.col(j);
    link.pose.R.col(j) = link.cosine * parent.R.col(j) - link.sine * parent.R.col(i);
  }
  link.pose.p = parent.p + parent.R * link.arm;
  return link.pose;
}

}  // namespace shapeid::fast
