#include "shapeid/models/sample_builder.hpp"

#include <Eigen/Geometry>

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

Eigen::VectorXd rotor_inertias(const Robot& robot) {
  Eigen::VectorXd inertias(robot.joint_count());
  for (int j = 0; j < robot.joint_count(); ++j) inertias[j] = robot.joint(j).rotor_inertia;
  return inertias;
}

namespace {

/// All but the derivatives, which `sample` has already. What a drive's rotor takes of its torque,
/// the links do not see.
void set_values(const ChannelPlan& plan, const Robot& robot, const Eigen::VectorXd& values,
                Sample& sample) {
  const Eigen::Index n = robot.joint_count();
  sample.q = values.segment(plan.q, n);
  sample.tau = values.segment(plan.tau, n);
  sample.tau -= rotor_inertias(robot).cwiseProduct(sample.ddq);
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
  sample.extra = row.extra;
  sample.dq = row.values.segment(plan.dq, n);
  sample.ddq = row.values.segment(plan.ddq, n);
  set_values(plan, robot, row.values, sample);
  if (plan.floating()) {
    set_base(imu, row.values.segment<3>(plan.gyro), row.values.segment<3>(plan.gyrodot),
             row.values.segment<3>(plan.accel), sample);
  }
  return sample;
}

}  // namespace shapeid
