// From rows of channels to samples: the IMU's place, and what each number is.
#pragma once

#include "shapeid/models/channels.hpp"
#include "shapeid/models/motion.hpp"

namespace shapeid {

/// Base quantities from what an IMU at pose `imu` (in the base frame) measures: turned into base
/// axes, and the specific force moved to the base origin,
/// a_base = a_imu - alpha x r - omega x (omega x r).
void set_base(const Eigen::Isometry3d& imu, const Eigen::Vector3d& gyro,
              const Eigen::Vector3d& gyrodot, const Eigen::Vector3d& accel, Sample& sample);

/// Of the drives' rotors, one a joint: times ddq it is what they take of the logged torque, and the
/// links do not see.
[[nodiscard]] Eigen::VectorXd rotor_inertias(const Robot& robot);

/// A sample from three rows of channels: the values, their derivative, and their second derivative.
[[nodiscard]] Sample make_sample(const ChannelPlan& plan, const Robot& robot,
                                 const Eigen::Isometry3d& imu, double time,
                                 const Eigen::VectorXd& values, const Eigen::VectorXd& first,
                                 const Eigen::VectorXd& second, bool logged_velocity);

/// A sample of a row whose derivatives are logged: dq, ddq and gyrodot must be in the plan.
[[nodiscard]] Sample make_exact_sample(const ChannelPlan& plan, const Robot& robot,
                                       const Eigen::Isometry3d& imu, const MeasuredRow& row);

}  // namespace shapeid
