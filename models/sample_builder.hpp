// From filtered rows to samples: derivatives, the IMU's place, settled ends, contacts.
#pragma once

#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "shapeid/models/channels.hpp"
#include "shapeid/models/motion.hpp"

namespace shapeid {

/// A sample with its contact flags still as numbers: 1, 0, or -1 for not known.
struct FlaggedSample {
  Sample sample;
  std::vector<int> contacts;
};

/// Base quantities from what an IMU at pose `imu` (in the base frame) measures: turned into base
/// axes, and the specific force moved to the base origin,
/// a_base = a_imu - alpha x r - omega x (omega x r).
void set_base(const Eigen::Isometry3d& imu, const Eigen::Vector3d& gyro,
              const Eigen::Vector3d& gyrodot, const Eigen::Vector3d& accel, Sample& sample);

/// A sample from three rows of channels: the values, their derivative, and their second derivative.
[[nodiscard]] Sample make_sample(const ChannelPlan& plan, const Robot& robot,
                                 const Eigen::Isometry3d& imu, double time,
                                 const Eigen::VectorXd& values, const Eigen::VectorXd& first,
                                 const Eigen::VectorXd& second, bool logged_velocity);

/// A sample of a row whose derivatives are logged: dq, ddq and gyrodot must be in the plan.
[[nodiscard]] Sample make_exact_sample(const ChannelPlan& plan, const Robot& robot,
                                       const Eigen::Isometry3d& imu, const MeasuredRow& row);

/// Holds samples back until it is known that no contact changes within the margin.
class ContactMargin {
 public:
  /// `margin` in s; 0 only drops samples whose contacts are not known.
  explicit ContactMargin(double margin) : margin_(margin) {}

  void push(FlaggedSample sample);
  /// The segment has ended: nothing after it counts for what came before.
  void finish();
  [[nodiscard]] std::optional<Sample> next();
  [[nodiscard]] std::size_t dropped() const { return dropped_; }

 private:
  void release();

  double margin_;
  std::deque<FlaggedSample> held_;
  std::deque<Sample> ready_;
  std::optional<std::vector<int>> last_contacts_;
  double last_time_ = 0.0;
  double blocked_until_ = -std::numeric_limits<double>::infinity();
  std::size_t dropped_ = 0;
};

}  // namespace shapeid
