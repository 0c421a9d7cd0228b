#include "shapeid/diagnosis/effects.hpp"

namespace shapeid::diagnosis {
namespace {

Sample turned_back(const Moment& moment, int, const Eigen::VectorXd& value) {
  Sample sample = moment.now;
  const double angle = value.norm();
  if (angle > 0.0) {
    sample.base_specific_force =
        Eigen::AngleAxisd(angle, value / angle) * sample.base_specific_force;
  }
  return sample;
}

}  // namespace

Effect accel_misalignment() {
  Effect e;
  e.id = "accel_misalignment";
  e.title = "the accelerometer is mounted askew: gravity is not where the base frame says";
  e.equation = "specific force turned by (x, y, z)";
  e.site = SiteKind::accelerometer;
  e.parameters = {{"x", "rad", false, 0.02, 0.3},
                  {"y", "rad", false, 0.02, 0.3},
                  {"z", "rad", false, 0.02, 0.3}};
  e.confused_with = {"accel_bias", "centre of mass of the base"};
  e.separate_by = "let the robot stand in two directions on a slope";
  e.under_contact = "seen as far as the base's balance is";
  e.source = "docs/derivations/moving-frame.md";
  e.transform.sample = turned_back;
  return e;
}

}  // namespace shapeid::diagnosis
