#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/parts.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::MatrixXd columns(const Instant& at, int joint, const Eigen::VectorXd&) {
  return joint_column(at, joint, at.sample.ddq[joint]);
}

}  // namespace

Effect rotor_inertia() {
  Effect e;
  e.id = "rotor_inertia";
  e.title = "inertia of the drive's rotor, seen through the gear";
  e.equation = "tau_j += I ddq_j";
  e.site = SiteKind::joint;
  e.parameters = {{"I", "kg m^2", true, 0.01}};
  e.confused_with = {"inertia of the link about its joint", "joint_spring"};
  e.separate_by = "turn the joint fast about an axis along gravity, and swing it across gravity";
  e.under_contact = "seen in swing; in stance only its part that no contact force can balance";
  e.source = "Featherstone, Rigid Body Dynamics Algorithms (2008), 9.6";
  e.built_in = true;
  e.columns = columns;
  e.is_usual = true;
  e.code.torque = "tau[j] += I * ddq[j];";
  return e;
}

}  // namespace shapeid::diagnosis
