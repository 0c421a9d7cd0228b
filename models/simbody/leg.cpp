#include "shapeid/models/simbody/leg.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "shapeid/models/error.hpp"

namespace shapeid {

Leg::Leg(const Robot& robot, const Contact& foot)
    : robot_(&robot), foot_(foot.frame.translation()) {
  for (int link = foot.link; link > 0; link = robot.links[static_cast<std::size_t>(link)].parent) {
    joints_.push_back(link - 1);
  }
  std::reverse(joints_.begin(), joints_.end());
  const bool turning = std::all_of(joints_.begin(), joints_.end(), [&](int j) {
    return robot.joint(j).kind != JointKind::prismatic;
  });
  if (joints_.size() != 3 || !turning) {
    throw InputError("the leg of " + foot.name + " cannot walk",
                     "three turning joints between base and foot");
  }
}

Eigen::Vector3d Leg::own(const Eigen::VectorXd& all) const {
  return {all[joints_[0]], all[joints_[1]], all[joints_[2]]};
}

Eigen::Vector3d Leg::position(const Eigen::Vector3d& q) const {
  Eigen::Vector3d p = foot_;
  for (int i = 2; i >= 0; --i) {
    const Joint& joint = robot_->joint(joints_[static_cast<std::size_t>(i)]);
    p = joint.placement * (Eigen::AngleAxisd(q[i], joint.axis) * p);
  }
  return p;
}

Eigen::Matrix3d Leg::jacobian(const Eigen::Vector3d& q) const {
  const Eigen::Vector3d foot = position(q);
  Eigen::Matrix3d J;
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i) {
    const Joint& joint = robot_->joint(joints_[static_cast<std::size_t>(i)]);
    frame = frame * joint.placement;
    J.col(i) = (frame.linear() * joint.axis).cross(foot - frame.translation());
    frame.rotate(Eigen::AngleAxisd(q[i], joint.axis));
  }
  return J;
}

Eigen::Vector3d Leg::holding_torque(const Eigen::Vector3d& q,
                                    const Eigen::Vector3d& gravity) const {
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  Eigen::Matrix3d origins, axes;
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i) {
    const int j = joints_[static_cast<std::size_t>(i)];
    const Joint& joint = robot_->joint(j);
    frame = frame * joint.placement;
    origins.col(i) = frame.translation();
    axes.col(i) = frame.linear() * joint.axis;
    frame.rotate(Eigen::AngleAxisd(q[i], joint.axis));
    const InertialParameters& body = robot_->links[static_cast<std::size_t>(j) + 1].inertia;
    const Eigen::Vector3d centre = frame * body.centre_of_mass();
    for (int k = 0; k <= i; ++k) {
      const Eigen::Vector3d arm = centre - origins.col(k);
      torque[k] -= body.mass() * axes.col(k).dot(arm.cross(gravity));
    }
  }
  return torque;
}

Eigen::Vector3d Leg::reach(const Eigen::Vector3d& target, const Eigen::Vector3d& guess) const {
  constexpr int rounds = 50;
  constexpr double close = 1e-10;  // m
  Eigen::Vector3d q = guess;
  for (int round = 0; round < rounds; ++round) {
    const Eigen::Vector3d miss = target - position(q);
    if (miss.norm() < close) return q;
    constexpr double longest_step = 0.5;  // rad: Newton far from the answer overshoots
    const Eigen::Vector3d step = jacobian(q).fullPivLu().solve(miss);
    q += step * std::min(1.0, longest_step / step.norm());
  }
  throw InputError("a foot cannot reach its place", "a posture within the legs' length");
}

}  // namespace shapeid
