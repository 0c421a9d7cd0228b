#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/parts.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::MatrixXd columns(const Instant& at, int joint, const Eigen::VectorXd& shape) {
  return joint_column(at, joint, direction_of(at.sample.dq[joint], shape[0]));
}

}  // namespace

Effect coulomb_friction() {
  Effect e;
  e.id = "coulomb_friction";
  e.title = "dry friction of constant size";
  e.equation = "tau_j += c tanh(dq_j / width)";
  e.site = SiteKind::joint;
  e.parameters = {{"c", "N m", true, 0.3}};
  e.shape = {step_width()};
  e.confused_with = {"viscous_friction", "stribeck_friction", "load_friction", "backlash"};
  e.separate_by = "move the joint alone at several constant speeds, both ways";
  e.under_contact = "seen in swing; in stance only its part that no contact force can balance";
  e.source = "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994)";
  e.columns = columns;
  e.is_usual = true;
  e.code.torque = "tau[j] += c * std::tanh(dq[j] / width);";
  return e;
}

}  // namespace shapeid::diagnosis
