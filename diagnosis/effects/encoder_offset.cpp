#include "shapeid/diagnosis/effects.hpp"

namespace shapeid::diagnosis {
namespace {

Sample turned(const Moment& moment, int joint, const Eigen::VectorXd& value) {
  Sample sample = moment.now;
  sample.q[joint] += value[0];
  return sample;
}

}  // namespace

Effect encoder_offset() {
  Effect e;
  e.id = "encoder_offset";
  e.title = "the joint stands elsewhere than the encoder says";
  e.equation = "q_j -> q_j + d in Y and J";
  e.site = SiteKind::joint;
  e.parameters = {{"d", "rad", false, 0.02, 0.3}};
  e.confused_with = {"centre of mass of the link", "contact_point", "torque_offset"};
  e.separate_by = "measure the joint's zero with a level or a calibration stop";
  e.under_contact = "seen where the foot then is; the link's own part as for any joint torque";
  e.source = "Hollerbach, Khalil, Gautier, Springer Handbook of Robotics (2016), ch. 6";
  e.transform.sample = turned;
  e.code.motion = "q[j] += d;";
  return e;
}

}  // namespace shapeid::diagnosis
