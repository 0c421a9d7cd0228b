#include "shapeid/reference/residual.hpp"

#include <algorithm>
#include <utility>

#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/projection.hpp"
#include "shapeid/reference/regressor.hpp"

namespace shapeid::reference {
namespace {

/// One column of residuals for each column of `Phis`.
Eigen::MatrixXd residuals(const Robot& robot, const Sample& sample, const Eigen::MatrixXd& Phis,
                          ContactTreatment contacts) {
  Eigen::VectorXd applied = applied_force(robot, sample);
  if (contacts == ContactTreatment::measured) applied += measured_contact_force(robot, sample);
  Eigen::MatrixXd r = regressor(robot, sample) * Phis;
  r.colwise() -= applied;
  if (contacts == ContactTreatment::project) {
    const Eigen::MatrixXd J = contact_jacobian(robot, sample);
    const Eigen::MatrixXd Q2 = contact_free_basis(J, Eigen::VectorXd::Ones(robot.dof())).Q2;
    r = Q2 * (Q2.transpose() * r);  // Q2 Q2^T = I - J^T (J^T)^+ does not depend on the basis
  }
  return r;
}

}  // namespace

Eigen::VectorXd residual(const Robot& robot, const Sample& sample, const Eigen::VectorXd& Phi,
                         ContactTreatment contacts) {
  return residuals(robot, sample, Phi, contacts);
}

ResidualTable::ResidualTable(const Robot& robot, ContactTreatment contacts,
                             std::vector<Eigen::VectorXd> models)
    : robot_(&robot),
      contacts_(contacts),
      models_(std::move(models)),
      squares_(Eigen::MatrixXd::Zero(robot.dof(), static_cast<Eigen::Index>(models_.size()))) {}

void ResidualTable::add(const Sample& sample) {
  Eigen::MatrixXd Phis(10 * robot_->link_count(), squares_.cols());
  for (std::size_t k = 0; k < models_.size(); ++k) {
    Phis.col(static_cast<Eigen::Index>(k)) = models_[k];
  }
  squares_ += residuals(*robot_, sample, Phis, contacts_).cwiseAbs2();
  ++samples_;
}

Eigen::MatrixXd ResidualTable::rms() const {
  return (squares_ / static_cast<double>(std::max<std::size_t>(samples_, 1))).cwiseSqrt();
}

}  // namespace shapeid::reference
