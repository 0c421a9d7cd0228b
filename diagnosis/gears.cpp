#include "shapeid/diagnosis/gears.hpp"

namespace shapeid::diagnosis {
namespace {

Sample ahead(const Moment& moment, int joint, const Eigen::VectorXd& value) {
  Sample sample = moment.now;
  sample.q[joint] += value[0];
  sample.ddq[joint] += value[1];
  return sample;
}

Effect make() {
  Effect e;
  e.id = "gear";
  e.title = "the encoder sits on the motor, before a gear that gives way";
  e.equation = "q_j -> q_j + d, ddq_j -> ddq_j + a";
  e.site = SiteKind::joint;
  e.parameters = {{"d", "rad", false, 0.02}, {"a", "rad/s^2", false, 1.0}};
  e.transform.sample = ahead;
  return e;
}

}  // namespace

const Effect& motor_ahead() {
  static const Effect effect = make();
  return effect;
}

}  // namespace shapeid::diagnosis
