#include "shapeid/diagnosis/effects.hpp"

namespace shapeid::diagnosis {
namespace {

Sample without_bias(const Moment& moment, int, const Eigen::VectorXd& value) {
  Sample sample = moment.now;
  sample.base_specific_force -= value;
  return sample;
}

}  // namespace

Effect accel_bias() {
  Effect e;
  e.id = "accel_bias";
  e.title = "the accelerometer reads a constant too much";
  e.equation = "specific force -> specific force - (x, y, z)";
  e.site = SiteKind::accelerometer;
  e.parameters = {{"x", "m/s^2", false, 0.2, 3.0},
                  {"y", "m/s^2", false, 0.2, 3.0},
                  {"z", "m/s^2", false, 0.2, 3.0}};
  e.confused_with = {"accel_misalignment (x, y)", "total mass and torque gains (z)",
                     "external_force on the base"};
  e.separate_by = "let the robot stand on its head, or on its side";
  e.under_contact = "seen as far as the base's balance is; z is a total mass too large";
  e.source = "docs/derivations/moving-frame.md";
  e.transform.sample = without_bias;
  return e;
}

}  // namespace shapeid::diagnosis
