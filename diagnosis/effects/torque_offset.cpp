#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/parts.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::MatrixXd columns(const Instant& at, int joint, const Eigen::VectorXd&) {
  return joint_column(at, joint, 1.0);
}

}  // namespace

Effect torque_offset() {
  Effect e;
  e.id = "torque_offset";
  e.title = "the torque reads a constant too much";
  e.equation = "tau_j += o";
  e.site = SiteKind::joint;
  e.parameters = {{"o", "N m", false, 0.3}};
  e.confused_with = {"joint_spring", "external_force", "encoder_offset",
                     "friction unequal in the two directions"};
  e.separate_by = "rest at two places where gravity loads the joint oppositely";
  e.under_contact = "seen in swing; in stance only its part that no contact force can balance";
  e.source = "Gautier, Khalil, Restrepo, ICRA 1995";
  e.columns = columns;
  e.is_usual = true;
  e.code.torque = "tau[j] += o;";
  return e;
}

}  // namespace shapeid::diagnosis
