#include "shapeid/reference/contact_detection.hpp"

#include <Eigen/QR>

#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/regressor.hpp"

namespace shapeid::reference {

namespace {

Sample with_all_contacts(const Robot& robot, const Sample& sample) {
  Sample all = sample;
  all.in_contact.assign(robot.contacts.size(), true);
  return all;
}

/// J_joints^T, which takes contact forces to joints.
Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> of_joints(const Robot& robot,
                                                                  const Sample& all) {
  const Eigen::MatrixXd J = contact_jacobian(robot, all);
  return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(
      J.rightCols(robot.joint_count()).transpose());
}

/// Of forces and moments at all contacts (rows) what is along the specific force, a row a contact.
Eigen::MatrixXd upward(const Robot& robot, const Sample& sample, const Eigen::MatrixXd& forces) {
  const Eigen::Vector3d up = sample.base_specific_force.normalized();
  Eigen::MatrixXd along(std::ssize(robot.contacts), forces.cols());
  Eigen::Index row = 0;
  for (Eigen::Index c = 0; c < along.rows(); ++c) {
    along.row(c) = up.transpose() * forces.middleRows<3>(row);
    row += force_numbers(robot.contacts[static_cast<std::size_t>(c)].kind);
  }
  return along;
}

}  // namespace

Eigen::VectorXd supporting_forces(const Robot& robot, const Sample& sample,
                                  const Eigen::VectorXd& Phi) {
  const Sample all = with_all_contacts(robot, sample);
  const Eigen::VectorXd asked = regressor(robot, all) * Phi - applied_force(robot, all);
  return upward(robot, sample, of_joints(robot, all).solve(asked.tail(robot.joint_count())));
}

Eigen::MatrixXd support_per_torque(const Robot& robot, const Sample& sample) {
  return upward(robot, sample, of_joints(robot, with_all_contacts(robot, sample)).pseudoInverse());
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
