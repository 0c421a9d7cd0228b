#include <cstddef>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/parts.hpp"

namespace shapeid::diagnosis {
namespace {

bool turns(const Robot& robot, int joint) {
  return robot.joint(joint).kind != JointKind::prismatic;
}

// The rotor spins G times as fast as the joint about the joint's axis z and rides on the parent.
// Its spin k dq z (k = G I_rotor) changes by k (ddq z + omega x z dq), which the parent must
// provide; and the parent's own turning about z speeds the rotor up, which the joint must provide.
Eigen::MatrixXd columns(const Instant& at, int joint, const Eigen::VectorXd&) {
  const Link& link = at.robot.links[static_cast<std::size_t>(joint) + 1];
  const reference::LinkMotion& parent = at.motions[static_cast<std::size_t>(link.parent)];
  const reference::LinkMotion& child = at.motions[static_cast<std::size_t>(joint) + 1];
  const Eigen::Vector3d z = child.pose.linear() * link.joint.axis;
  const Eigen::Vector3d moment =
      z * at.sample.ddq[joint] + parent.angular_velocity.cross(z) * at.sample.dq[joint];
  const reference::Jacobian J =
      reference::point_jacobian(at.robot, at.motions, link.parent, parent.pose.translation());
  Eigen::MatrixXd column = J.bottomRows<3>().transpose() * moment;
  column(at.robot.base_dof() + joint, 0) += z.dot(parent.angular_acceleration);
  return column;
}

}  // namespace

Effect rotor_reaction() {
  Effect e;
  e.id = "rotor_reaction";
  e.title = "the spinning rotor turns the link that carries the drive, and gyroscopics";
  e.equation =
      "tau += J_w(parent)^T k (ddq_j z_j + omega(parent) x z_j dq_j), and at j itself "
      "k z_j . alpha(parent); k = gear times rotor inertia";
  e.site = SiteKind::joint;
  e.parameters = {{"k", "kg m^2", true, 0.002}};
  e.confused_with = {"rotor_inertia", "inertia of the parent link"};
  e.separate_by = "accelerate this joint while the others are held, and look at their torques";
  e.under_contact = "the part on the base is hidden as far as feet can balance it";
  e.source = "Featherstone, Rigid Body Dynamics Algorithms (2008), 9.6";
  e.built_in = true;
  e.applies = turns;
  e.columns = columns;
  e.code.link =
      "at.n[at.parent(j)] += k * (at.z[j] * ddq[j] + cross(at.w[at.parent(j)], at.z[j]) * dq[j]);"
      " tau[j] += k * dot(at.z[j], at.alpha[at.parent(j)]);";
  return e;
}

}  // namespace shapeid::diagnosis
