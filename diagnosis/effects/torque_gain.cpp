#include "shapeid/diagnosis/effects.hpp"

namespace shapeid::diagnosis {
namespace {

// Scales the prediction, contact forces included, never the logged torque: a column of measured
// torque would shrink the yardstick itself.
void scale(const Robot& robot, const Sample&, const Eigen::Vector3d&, int joint,
           const Eigen::VectorXd& value, Rows& rows) {
  const Eigen::Index row = robot.base_dof() + joint;
  rows.E.row(row) *= 1.0 + value[0];
  rows.J.col(row) *= 1.0 + value[0];
}

}  // namespace

Effect torque_gain() {
  Effect e;
  e.id = "torque_gain";
  e.title = "the torque is read too large by a factor (current constant, gear, efficiency)";
  e.equation = "tau_j -> (1 + g) tau_j";
  e.site = SiteKind::joint;
  e.parameters = {{"g", "1", false, 0.1, 0.8}};
  e.confused_with = {"masses beyond the joint", "load_friction"};
  e.separate_by = "attach a known load beyond the joint";
  e.under_contact = "in stance seen only against the base's balance and the other legs";
  e.source = "Gautier, Briot, ASME J. Dyn. Syst. Meas. Control 136 (2014)";
  e.transform.rows = scale;
  e.transform.scales = true;
  e.code.torque = "tau[j] *= 1.0 + g;";
  return e;
}

}  // namespace shapeid::diagnosis
