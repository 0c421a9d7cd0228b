#include "shapeid/reference/inverse_dynamics.hpp"

#include <cstddef>

#include "shapeid/models/contract.hpp"
#include "shapeid/models/inertia.hpp"

namespace shapeid::reference {
namespace {

/// What a link and all that it carries take, base axes, about the base origin: so wrenches of
/// different links add as they are.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
};

/// Equation (2) for one body:
///   f = m a + alpha x h + omega x (omega x h)
///   n = h x a + I alpha + omega x (I omega),   h = m r, I about the link origin.
Wrench wrench_of(const InertialParameters& body, const LinkMotion& link) {
  const Eigen::Matrix3d R = link.pose.linear();
  const Eigen::Vector3d &omega = link.angular_velocity, &alpha = link.angular_acceleration,
                        &a = link.proper_acceleration;
  const Eigen::Vector3d h = R * body.first_moment();
  const auto times_tensor = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
    return R * (body.tensor() * (R.transpose() * v));
  };
  Wrench w;
  w.force = body.mass() * a + alpha.cross(h) + omega.cross(omega.cross(h));
  w.moment = h.cross(a) + times_tensor(alpha) + omega.cross(times_tensor(omega)) +
             link.pose.translation().cross(w.force);
  return w;
}

}  // namespace

Eigen::VectorXd inverse_dynamics(const Robot& robot, const std::vector<LinkMotion>& motions,
                                 const Eigen::VectorXd& Phi) {
  SHAPEID_CONTRACT(why_not_stacked(Phi, robot));
  SHAPEID_CONTRACT(why_not_motions(motions, robot));
  Eigen::VectorXd force = Eigen::VectorXd::Zero(robot.dof());
  std::vector<Wrench> taken(motions.size());
  // Children stand behind their parents.
  for (int i = robot.link_count() - 1; i >= 0; --i) {
    const auto place = static_cast<std::size_t>(i);
    const LinkMotion& link = motions[place];
    Wrench& w = taken[place];
    const Wrench own = wrench_of({Phi.segment<10>(Eigen::Index{10} * i)}, link);
    w.force += own.force;
    w.moment += own.moment;
    if (i == 0) continue;
    // Equation (3): of the wrench, the joint provides what works along its motion.
    const Joint& joint = robot.joint(i - 1);
    const Eigen::Vector3d z = link.pose.linear() * joint.axis;
    force[robot.base_dof() + i - 1] =
        joint.kind == JointKind::prismatic
            ? z.dot(w.force)
            : z.dot(w.moment - link.pose.translation().cross(w.force));
    Wrench& parent = taken[static_cast<std::size_t>(robot.links[place].parent)];
    parent.force += w.force;
    parent.moment += w.moment;
  }
  if (robot.root == Root::floating) force.head<6>() << taken[0].force, taken[0].moment;
  return force;
}

}  // namespace shapeid::reference
