#include <cstddef>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/payload_parts.hpp"

namespace shapeid::diagnosis {
namespace {

/// Velocity of the base origin, base axes: the mean of what the standing feet say; zero for a fixed
/// base. False if nothing stands.
bool base_velocity(const Instant& at, Eigen::Vector3d& velocity) {
  velocity.setZero();
  if (at.robot.root == Root::fixed) return true;
  int standing = 0;
  for (std::size_t c = 0; c < at.sample.in_contact.size(); ++c) {
    if (!at.sample.in_contact[c]) continue;
    const Contact& contact = at.robot.contacts[c];
    const auto& link = at.motions[static_cast<std::size_t>(contact.link)];
    const Eigen::Vector3d arm = link.pose.linear() * contact.frame.translation();
    velocity -= link.velocity + link.angular_velocity.cross(arm);
    ++standing;
  }
  if (standing > 0) velocity /= standing;
  return standing > 0;
}

Eigen::MatrixXd columns(const Instant& at, int link, const Eigen::VectorXd&) {
  Eigen::Vector3d base;
  if (!base_velocity(at, base)) return Eigen::MatrixXd::Zero(at.robot.dof(), 1);
  const auto& motion = at.motions[static_cast<std::size_t>(link)];
  const reference::Jacobian J =
      reference::point_jacobian(at.robot, at.motions, link, motion.pose.translation());
  return J.topRows<3>().transpose() * (base + motion.velocity);
}

}  // namespace

Effect drag() {
  Effect e;
  e.id = "drag";
  e.title = "a force against the link's velocity (water, a brush, air at low speed)";
  e.equation = "tau += J_link^T c v_link; the base's velocity is what standing feet say";
  e.site = SiteKind::link;
  e.parameters = {{"c", "N s/m", true, 2.0}};
  e.confused_with = {"viscous_friction", "external_force (at constant speed)"};
  e.separate_by = "the same motion at several speeds, and in the air";
  e.under_contact = "on the base hidden as far as feet can balance it; nothing in flight";
  e.source = "Stokes' law";
  e.applies = moves;
  e.columns = columns;
  return e;
}

}  // namespace shapeid::diagnosis
