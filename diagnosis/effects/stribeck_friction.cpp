#include <cmath>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/parts.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::MatrixXd columns(const Instant& at, int joint, const Eigen::VectorXd& shape) {
  const double dq = at.sample.dq[joint];
  const double slow = std::exp(-std::pow(dq / shape[0], 2));
  return joint_column(at, joint, slow * direction_of(dq, shape[1]));
}

}  // namespace

Effect stribeck_friction() {
  Effect e;
  e.id = "stribeck_friction";
  e.title = "friction that is larger at low speed";
  e.equation = "tau_j += s exp(-(dq_j / v)^2) tanh(dq_j / width)";
  e.site = SiteKind::joint;
  e.parameters = {{"s", "N m", true, 0.3}};
  ShapeNumber width = step_width();
  width.start = 0.02;
  e.shape = {{"v", "rad/s", 0.02, 2.0, 0.2}, width};
  e.confused_with = {"coulomb_friction", "backlash"};
  e.separate_by = "move the joint alone through slow constant speeds, both ways";
  e.under_contact = "seen in swing; in stance only its part that no contact force can balance";
  e.source = "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994)";
  e.columns = columns;
  e.code.torque = "tau[j] += s * std::exp(-(dq[j] / v) * (dq[j] / v)) * std::tanh(dq[j] / width);";
  return e;
}

}  // namespace shapeid::diagnosis
