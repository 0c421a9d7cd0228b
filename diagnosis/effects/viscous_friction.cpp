#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/parts.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::MatrixXd columns(const Instant& at, int joint, const Eigen::VectorXd&) {
  return joint_column(at, joint, at.sample.dq[joint]);
}

}  // namespace

Effect viscous_friction() {
  Effect e;
  e.id = "viscous_friction";
  e.title = "friction that grows with velocity";
  e.equation = "tau_j += b dq_j";
  e.site = SiteKind::joint;
  e.parameters = {{"b", "N m s/rad", true, 0.1}};
  e.confused_with = {"coulomb_friction", "stribeck_friction", "torque_delay",
                     "unequal filtering of torque and joints"};
  e.separate_by = "move the joint alone at several constant speeds, both ways";
  e.under_contact = "seen in swing; in stance only its part that no contact force can balance";
  e.source = "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994)";
  e.columns = columns;
  e.is_usual = true;
  e.code.torque = "tau[j] += b * dq[j];";
  return e;
}

}  // namespace shapeid::diagnosis
