#include "shapeid/diagnosis/effects.hpp"

namespace shapeid::diagnosis {
namespace {

bool is_fixed(const Robot& robot, int) { return robot.root == Root::fixed; }

Sample tilted(const Moment& moment, int, const Eigen::VectorXd& value) {
  Sample sample = moment.now;
  const Eigen::Vector3d by(value[0], value[1], 0.0);
  const double angle = by.norm();
  if (angle > 0.0) {
    sample.base_specific_force = Eigen::AngleAxisd(angle, by / angle) * sample.base_specific_force;
  }
  return sample;
}

}  // namespace

Effect gravity_tilt() {
  Effect e;
  e.id = "gravity_tilt";
  e.title = "a fixed base does not stand upright";
  e.equation = "specific force turned by (roll, pitch, 0)";
  e.site = SiteKind::whole;
  // More than a quarter turn: a base may hang on a wall (quarter_turns.hpp).
  e.parameters = {{"roll", "rad", false, 0.02, 2.0}, {"pitch", "rad", false, 0.02, 2.0}};
  e.confused_with = {"encoder_offset of the first joints"};
  e.separate_by = "put a level on the base";
  e.under_contact = "not hidden: fixed bases only";
  e.source = "docs/derivations/moving-frame.md";
  e.applies = is_fixed;
  e.transform.sample = tilted;
  return e;
}

}  // namespace shapeid::diagnosis
