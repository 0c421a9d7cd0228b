#include "shapeid/models/motion_extent.hpp"

namespace shapeid {
namespace {

constexpr Eigen::Index base = 6;  // gyro and specific force

}  // namespace

bool moved_far(const Joint& joint, double way) {
  constexpr double angle = 0.1, length = 0.01;
  return way > (joint.kind == JointKind::prismatic ? length : angle);
}

void MotionExtent::add(const Sample& sample) {
  Eigen::ArrayXd now(base + sample.q.size());
  now << sample.base_angular_velocity, sample.base_specific_force, sample.q;
  if (least_.size() == 0) least_ = most_ = now;
  least_ = least_.min(now);
  most_ = most_.max(now);
}

bool MotionExtent::some_joint_moved(const Robot& robot) const {
  constexpr double angle = 0.02, length = 1e-3;
  for (int j = 0; j < robot.joint_count() && least_.size() > 0; ++j) {
    const bool slides = robot.joint(j).kind == JointKind::prismatic;
    if (most_[base + j] - least_[base + j] > (slides ? length : angle)) return true;
  }
  return false;
}

bool MotionExtent::base_moved() const {
  constexpr double turn = 0.1, force = 1.0;
  if (least_.size() == 0) return false;
  const Eigen::ArrayXd range = (most_ - least_).head(base);
  return range.head(3).maxCoeff() > turn || range.tail(3).maxCoeff() > force;
}

}  // namespace shapeid
