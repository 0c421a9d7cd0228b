#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/parts.hpp"

namespace shapeid::diagnosis {
namespace {

// A late IMU shows at t what the base did at t - d, so the base's motion at t is logged at t + d.
Sample realigned(const Moment& moment, int, const Eigen::VectorXd& value) {
  Sample sample = moment.now;
  const Sample later = moment.at(value[0]);
  sample.base_angular_velocity = later.base_angular_velocity;
  sample.base_angular_acceleration = later.base_angular_acceleration;
  sample.base_specific_force = later.base_specific_force;
  return sample;
}

}  // namespace

Effect imu_delay() {
  Effect e;
  e.id = "imu_delay";
  e.title = "the IMU is logged later than the joints";
  e.equation = "base motion at t is read at t + d";
  e.site = SiteKind::whole;
  e.parameters = {{"d", "s", false, 0.004, largest_delay}};
  e.confused_with = {"torque_delay", "accel_misalignment"};
  e.separate_by = "tap the robot: the same knock must come at the same time in all channels";
  e.under_contact = "seen as far as the base's balance is";
  e.source = "docs/derivations/filtering.md";
  e.applies = is_floating;
  e.transform.sample = realigned;
  return e;
}

}  // namespace shapeid::diagnosis
