#include "shapeid/reference/kinematics.hpp"

#include <cstddef>

namespace shapeid::reference {
namespace {

LinkMotion base_motion(const Sample& sample) {
  return {Eigen::Isometry3d::Identity(), sample.base_angular_velocity, Eigen::Vector3d::Zero(),
          sample.base_angular_acceleration, sample.base_specific_force};
}

/// A link as its parent carries it: the velocity and acceleration of a point fixed to the parent,
/// plus what the joint adds. z is the joint's axis, r leads from the parent's origin to the link's.
LinkMotion carried_by(const LinkMotion& parent, const Joint& joint, double q, double dq,
                      double ddq) {
  const bool slides = joint.kind == JointKind::prismatic;
  Eigen::Isometry3d displacement = Eigen::Isometry3d::Identity();
  if (slides) {
    displacement.translation() = q * joint.axis;
  } else {
    displacement.linear() = Eigen::AngleAxisd(q, joint.axis).toRotationMatrix();
  }

  LinkMotion link;
  link.pose = parent.pose * joint.placement * displacement;
  const Eigen::Vector3d z = link.pose.linear() * joint.axis;
  const Eigen::Vector3d r = link.pose.translation() - parent.pose.translation();
  const Eigen::Vector3d& omega = parent.angular_velocity;
  const Eigen::Vector3d& alpha = parent.angular_acceleration;

  link.angular_velocity = omega;
  link.angular_acceleration = alpha;
  link.velocity = parent.velocity + omega.cross(r);
  link.proper_acceleration =
      parent.proper_acceleration + alpha.cross(r) + omega.cross(omega.cross(r));
  if (slides) {
    link.velocity += z * dq;
    link.proper_acceleration += z * ddq + 2.0 * omega.cross(z * dq);  // Coriolis
  } else {
    link.angular_velocity += z * dq;
    link.angular_acceleration += z * ddq + omega.cross(z * dq);  // the axis itself is turned
  }
  return link;
}

}  // namespace

std::vector<LinkMotion> link_motions(const Robot& robot, const Sample& sample) {
  SHAPEID_CONTRACT(why_malformed(sample, robot));
  std::vector<LinkMotion> motions = {base_motion(sample)};
  for (int j = 0; j < robot.joint_count(); ++j) {
    const Link& link = robot.links[static_cast<std::size_t>(j) + 1];
    const LinkMotion& parent = motions[static_cast<std::size_t>(link.parent)];
    motions.push_back(carried_by(parent, link.joint, sample.q[j], sample.dq[j], sample.ddq[j]));
  }
  return motions;
}

Violation why_not_motions(const std::vector<LinkMotion>& motions, const Robot& robot) {
  if (motions.size() == robot.links.size()) return std::nullopt;
  return "not one motion for each link";
}

Jacobian point_jacobian(const Robot& robot, const std::vector<LinkMotion>& motions, int link,
                        const Eigen::Vector3d& point) {
  Jacobian J = Jacobian::Zero(6, robot.dof());
  if (robot.root == Root::floating) {
    // The base frame's axes are the columns: v + omega x point.
    J.topLeftCorner<3, 3>().setIdentity();
    J.block<3, 3>(0, 3) = -skew(point);
    J.block<3, 3>(3, 3).setIdentity();
  }
  // Only the joints between the link and the root move the point; joint i - 1 carries link i.
  for (int i = link; i != 0; i = robot.links[static_cast<std::size_t>(i)].parent) {
    const Joint& joint = robot.joint(i - 1);
    const Eigen::Isometry3d& pose = motions[static_cast<std::size_t>(i)].pose;
    const Eigen::Vector3d z = pose.linear() * joint.axis;
    auto column = J.col(robot.base_dof() + i - 1);
    if (joint.kind == JointKind::prismatic) {
      column.head<3>() = z;
    } else {
      column << z.cross(point - pose.translation()), z;
    }
  }
  return J;
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(),  //
      v.z(), 0.0, -v.x(),   //
      -v.y(), v.x(), 0.0;
  return m;
}

}  // namespace shapeid::reference
