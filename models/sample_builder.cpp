#include "shapeid/models/sample_builder.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

namespace shapeid {

void set_base(const Eigen::Isometry3d& imu, const Eigen::Vector3d& gyro,
              const Eigen::Vector3d& gyrodot, const Eigen::Vector3d& accel, Sample& sample) {
  const Eigen::Matrix3d R = imu.linear();
  const Eigen::Vector3d r = imu.translation();
  const Eigen::Vector3d omega = R * gyro, alpha = R * gyrodot;
  sample.base_angular_velocity = omega;
  sample.base_angular_acceleration = alpha;
  sample.base_specific_force = R * accel - alpha.cross(r) - omega.cross(omega.cross(r));
}

namespace {

/// All but the derivatives, which `sample` has already.
void set_values(const ChannelPlan& plan, const Robot& robot, const Eigen::VectorXd& values,
                Sample& sample) {
  const Eigen::Index n = robot.joint_count();
  sample.q = values.segment(plan.q, n);
  sample.tau = values.segment(plan.tau, n);
  if (plan.force < 0) return;
  for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
    sample.contact_force.emplace_back(
        values.segment<3>(plan.force + 3 * static_cast<Eigen::Index>(c)));
  }
}

}  // namespace

Sample make_sample(const ChannelPlan& plan, const Robot& robot, const Eigen::Isometry3d& imu,
                   double time, const Eigen::VectorXd& values, const Eigen::VectorXd& first,
                   const Eigen::VectorXd& second, bool logged_velocity) {
  const Eigen::Index n = robot.joint_count();
  Sample sample;
  sample.time = time;
  sample.dq = logged_velocity ? values.segment(plan.dq, n) : first.segment(plan.q, n);
  sample.ddq = logged_velocity ? first.segment(plan.dq, n) : second.segment(plan.q, n);
  set_values(plan, robot, values, sample);
  if (plan.floating()) {
    set_base(imu, values.segment<3>(plan.gyro), first.segment<3>(plan.gyro),
             values.segment<3>(plan.accel), sample);
  }
  return sample;
}

Sample make_exact_sample(const ChannelPlan& plan, const Robot& robot, const Eigen::Isometry3d& imu,
                         const MeasuredRow& row) {
  const Eigen::Index n = robot.joint_count();
  Sample sample;
  sample.time = row.time;
  sample.dq = row.values.segment(plan.dq, n);
  sample.ddq = row.values.segment(plan.ddq, n);
  set_values(plan, robot, row.values, sample);
  if (plan.floating()) {
    set_base(imu, row.values.segment<3>(plan.gyro), row.values.segment<3>(plan.gyrodot),
             row.values.segment<3>(plan.accel), sample);
  }
  return sample;
}

void ContactMargin::push(FlaggedSample sample) {
  const double now = sample.sample.time;
  if (last_contacts_ && *last_contacts_ != sample.contacts) {
    blocked_until_ = last_time_ + margin_;
    while (!held_.empty() && held_.back().sample.time > now - margin_) {
      held_.pop_back();
      ++dropped_;
    }
  }
  last_contacts_ = sample.contacts;
  last_time_ = now;
  const bool known =
      std::find(sample.contacts.begin(), sample.contacts.end(), -1) == sample.contacts.end();
  if (known && now >= blocked_until_) {
    held_.push_back(std::move(sample));
  } else {
    ++dropped_;
  }
  while (!held_.empty() && held_.front().sample.time <= now - margin_) release();
}

void ContactMargin::finish() {
  while (!held_.empty()) release();
  last_contacts_.reset();
}

void ContactMargin::release() {
  Sample sample = std::move(held_.front().sample);
  for (const int flag : held_.front().contacts) sample.in_contact.push_back(flag == 1);
  held_.pop_front();
  ready_.push_back(std::move(sample));
}

std::optional<Sample> ContactMargin::next() {
  if (ready_.empty()) return std::nullopt;
  Sample sample = std::move(ready_.front());
  ready_.pop_front();
  return sample;
}

}  // namespace shapeid
