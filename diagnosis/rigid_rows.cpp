#include "shapeid/diagnosis/rigid_rows.hpp"

#include <numeric>

#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/inverse_dynamics.hpp"
#include "shapeid/reference/projection.hpp"
#include "shapeid/reference/regressor.hpp"

namespace shapeid::diagnosis {
namespace {

std::vector<int> all_links(const Robot& robot) {
  std::vector<int> links(static_cast<std::size_t>(robot.link_count()));
  std::iota(links.begin(), links.end(), 0);
  return links;
}

Eigen::Index most_forces(const Robot& robot) {
  Eigen::Index count = 0;
  for (const Contact& contact : robot.contacts) count += force_numbers(contact.kind);
  return count;
}

}  // namespace

RigidRows::Fast::Fast(const Robot& robot)
    : regressor(robot, all_links(robot)), kinematics(robot), jacobian(robot) {}

RigidRows::RigidRows(const Robot& robot, Path path) {
  if (path == Path::fast) fast_.emplace(robot);
}

Eigen::MatrixXd RigidRows::regressor(const Robot& robot, const Sample& sample,
                                     const std::vector<reference::LinkMotion>& motions) {
  return fast_ ? fast_->regressor(sample) : reference::regressor(robot, motions);
}

Eigen::VectorXd RigidRows::inverse_dynamics(const Robot& robot, const Sample& sample,
                                            const std::vector<reference::LinkMotion>& motions,
                                            const Eigen::VectorXd& Phi) {
  if (!fast_) return reference::inverse_dynamics(robot, motions, Phi);
  if (!fast_->dynamics || fast_->Phi != Phi) {
    fast_->Phi = Phi;
    fast_->dynamics.emplace(robot, Phi);
  }
  fast_->kinematics.start(sample);
  return (*fast_->dynamics)(fast_->kinematics);
}

Eigen::MatrixXd RigidRows::contact_jacobian(const Robot& robot, const Sample& sample,
                                            const std::vector<reference::LinkMotion>& motions) {
  if (!fast_) return reference::contact_jacobian(robot, motions, sample.in_contact);
  fast_->kinematics.start(sample);
  fast_->jacobian.update(fast_->kinematics, sample);
  return fast_->jacobian.transposed().transpose();
}

ContactFree::ContactFree(const Robot& robot, const Eigen::VectorXd& weight, Path path)
    : weight_(weight), root_(weight.cwiseSqrt()) {
  if (path == Path::fast) fast_.emplace(weight, most_forces(robot));
}

Eigen::MatrixXd ContactFree::operator()(const Eigen::MatrixXd& J, const Eigen::MatrixXd& rows) {
  if (!fast_) {
    const Eigen::MatrixXd Q2 = reference::contact_free_basis(J, weight_).Q2;
    return Q2.transpose() * (root_.asDiagonal() * rows);
  }
  Eigen::MatrixXd turned = rows;
  const Eigen::MatrixXd JT = J.transpose();
  const Eigen::Index rank = (*fast_)(JT, turned);
  return turned.bottomRows(turned.rows() - rank);
}

Eigen::MatrixXd ContactFree::beyond(const Eigen::MatrixXd& J, const Eigen::MatrixXd& force) {
  if (!fast_) {
    const Eigen::MatrixXd Q2 = reference::contact_free_basis(J, weight_).Q2;
    return Q2 * (Q2.transpose() * force);
  }
  const Eigen::MatrixXd Q2T = (*this)(J, Eigen::MatrixXd::Identity(weight_.size(), weight_.size()));
  return Q2T.transpose() * (Q2T * force);
}

}  // namespace shapeid::diagnosis
