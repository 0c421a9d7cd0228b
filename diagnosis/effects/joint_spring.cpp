#include "shapeid/diagnosis/effects.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::MatrixXd columns(const Instant& at, int joint, const Eigen::VectorXd&) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(at.robot.dof(), 2);
  columns.row(at.robot.base_dof() + joint) << at.sample.q[joint], 1.0;
  return columns;
}

}  // namespace

Effect joint_spring() {
  Effect e;
  e.id = "joint_spring";
  e.title = "a spring, or a cable that pulls like one";
  e.equation = "tau_j += k q_j + p";
  e.site = SiteKind::joint;
  e.parameters = {{"k", "N m/rad", true, 0.5}, {"p", "N m", false, 0.5}};
  e.confused_with = {"torque_offset", "gravity on the link", "rotor_inertia"};
  e.separate_by = "rest at several places of the joint about an axis along gravity";
  e.under_contact = "seen in swing; in stance only its part that no contact force can balance";
  e.source = "Hooke's law";
  e.columns = columns;
  e.code.torque = "tau[j] += k * q[j] + p;";
  return e;
}

}  // namespace shapeid::diagnosis
