#include <cmath>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/parts.hpp"

namespace shapeid::diagnosis {
namespace {

// The load is predicted: with the measured torque in it the column would contain what it predicts.
Eigen::MatrixXd columns(const Instant& at, int joint, const Eigen::VectorXd& shape) {
  const double direction = direction_of(at.sample.dq[joint], shape[0]);
  return joint_column(at, joint, std::abs(at.load[joint]) * direction);
}

}  // namespace

Effect load_friction() {
  Effect e;
  e.id = "load_friction";
  e.title = "dry friction that grows with the load";
  e.equation = "tau_j += mu |load_j| tanh(dq_j / width)";
  e.site = SiteKind::joint;
  e.parameters = {{"mu", "1", true, 0.1}};
  e.shape = {step_width()};
  e.confused_with = {"coulomb_friction", "torque_gain"};
  e.separate_by = "the same slow motion with and without a known load";
  e.under_contact =
      "the load in stance is predicted from the base's balance, and what feet push "
      "against each other from the torque";
  e.source = "Hamon, Gautier, Garrec, ICRA 2010";
  e.columns = columns;
  e.code.torque = "tau[j] += mu * std::abs(load[j]) * std::tanh(dq[j] / width);";
  return e;
}

}  // namespace shapeid::diagnosis
