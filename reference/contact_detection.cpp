#include "shapeid/reference/contact_detection.hpp"

#include <Eigen/QR>

#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/regressor.hpp"

namespace shapeid::reference {

Eigen::VectorXd supporting_forces(const Robot& robot, const Sample& sample,
                                  const Eigen::VectorXd& Phi) {
  Sample all = sample;
  all.in_contact.assign(robot.contacts.size(), true);
  const Eigen::MatrixXd J = contact_jacobian(robot, all);
  const Eigen::VectorXd asked = regressor(robot, all) * Phi - applied_force(robot, all);
  const Eigen::Index n = robot.joint_count();
  const Eigen::MatrixXd Jt = J.rightCols(n).transpose();
  const Eigen::VectorXd f =
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(Jt).solve(asked.tail(n));

  const Eigen::Vector3d up = sample.base_specific_force.normalized();
  Eigen::VectorXd supporting(static_cast<Eigen::Index>(robot.contacts.size()));
  Eigen::Index row = 0;
  for (Eigen::Index c = 0; c < supporting.size(); ++c) {
    supporting[c] = f.segment<3>(row).dot(up);
    row += force_numbers(robot.contacts[static_cast<std::size_t>(c)].kind);
  }
  return supporting;
}

std::vector<bool> detect_contacts(const Robot& robot, const Sample& sample,
                                  const Eigen::VectorXd& Phi, double share) {
  double mass = 0.0;
  for (int i = 0; i < robot.link_count(); ++i) mass += Phi[Eigen::Index{10} * i];
  constexpr double gravity = 9.81;
  const Eigen::VectorXd force = supporting_forces(robot, sample, Phi);
  // How a link's force is shared among its points no torque tells.
  Eigen::VectorXd on_link = Eigen::VectorXd::Zero(robot.link_count());
  for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
    on_link[robot.contacts[c].link] += force[static_cast<Eigen::Index>(c)];
  }
  std::vector<bool> touching;
  touching.reserve(robot.contacts.size());
  for (const Contact& contact : robot.contacts) {
    touching.push_back(on_link[contact.link] > share * mass * gravity);
  }
  return touching;
}

}  // namespace shapeid::reference
