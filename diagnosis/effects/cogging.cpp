#include <cmath>

#include "shapeid/diagnosis/effects.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::MatrixXd columns(const Instant& at, int joint, const Eigen::VectorXd& shape) {
  const double phase = shape[0] * at.sample.q[joint];
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(at.robot.dof(), 2);
  columns.row(at.robot.base_dof() + joint) << std::cos(phase), std::sin(phase);
  return columns;
}

}  // namespace

Effect cogging() {
  Effect e;
  e.id = "cogging";
  e.title = "ripple with the joint's position";
  e.equation = "tau_j += a cos(N q_j) + b sin(N q_j)";
  e.site = SiteKind::joint;
  e.parameters = {{"a", "N m", false, 0.2}, {"b", "N m", false, 0.2}};
  // Slower than this it is a spring or gravity, faster a filter at 20 Hz leaves nothing of it.
  e.shape = {{"N", "1/rad", 4.0, 200.0, 12.0, 0.03}};
  e.confused_with = {"gear transmission error", "joint_spring"};
  e.separate_by = "turn the joint slowly at constant speed over its whole range";
  e.under_contact = "seen in swing; in stance only its part that no contact force can balance";
  e.source = "Holtz, Springob, IEEE Trans. Ind. Electron. 43 (1996)";
  e.columns = columns;
  e.code.torque = "tau[j] += a * std::cos(N * q[j]) + b * std::sin(N * q[j]);";
  return e;
}

}  // namespace shapeid::diagnosis
