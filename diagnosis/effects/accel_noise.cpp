#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/parts.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr double gravity = 9.81;  // m/s^2

// What is expected of the true acceleration, given one that has noise of its own kind in it, is a
// share of it (regression calibration). Without it noise makes every mass too small that is known
// by its inertia, and not that which is known by its weight.
Sample calibrated(const Moment& moment, int, const Eigen::VectorXd& value) {
  Sample sample = moment.now;
  const Eigen::Vector3d at_rest = -gravity * moment.surroundings.down;
  sample.base_specific_force -= value[0] * (sample.base_specific_force - at_rest);
  return sample;
}

}  // namespace

Effect accel_noise() {
  Effect e;
  e.id = "accel_noise";
  e.title = "a share of what the accelerometer adds to gravity is no motion of the base";
  e.equation = "specific force -> -g + (1 - n) (specific force + g)";
  e.site = SiteKind::accelerometer;
  e.parameters = {{"n", "1", true, 0.1, 1.0}};
  e.confused_with = {"external_force on the base, that takes over its weight",
                     "a torque that is a command and lacks what accelerates the base"};
  e.separate_by =
      "lift the base on soft springs: what the accelerometer shows must be what the springs do";
  e.under_contact = "seen as far as the base's balance is";
  e.source =
      "Carroll, Ruppert, Stefanski, Crainiceanu, Measurement Error in Nonlinear Models "
      "(2006), ch. 4";
  e.applies = is_floating;
  e.transform.sample = calibrated;
  return e;
}

}  // namespace shapeid::diagnosis
