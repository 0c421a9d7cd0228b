#include "shapeid/tests/experiments/studies/torque_scale.hpp"

#include <Eigen/QR>
#include <cmath>

#include "shapeid/reference/projection.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/reference/sample_rows.hpp"
#include "shapeid/reference/triangle.hpp"

namespace shapeid::experiments {

ScaledRows::ScaledRows(const Robot& robot, const BodyModel& model,
                       const std::vector<Sample>& samples)
    : R_(0, 12), samples_(static_cast<double>(samples.size())) {
  const Eigen::VectorXd W = Eigen::VectorXd::Ones(robot.dof());
  for (const Sample& sample : samples) {
    const auto rows = reference::sample_rows(robot, model.known, model.free_links,
                                             ContactTreatment::project, sample);
    const Eigen::VectorXd tau = reference::applied_force(robot, sample);
    Eigen::MatrixXd both(rows.Y.rows(), 11);
    both << rows.Y, tau - rows.F;  // F = tau - known
    const auto kept = reference::eliminate_contacts(both, tau, rows.J, W);
    Eigen::MatrixXd all(kept.Y.rows(), 12);
    all << kept.Y, kept.F;
    R_ = reference::triangle(reference::stacked(R_, all));
  }
}

DataTerm ScaledRows::at(double s) const {
  Eigen::MatrixXd rows(R_.rows(), 11);
  rows << R_.leftCols(10), s * R_.col(11) - R_.col(10);
  return DataTerm(reference::triangle(rows));
}

double ScaledRows::rms(double s, const Vector10& Phi) const {
  return std::sqrt(at(s).value(Phi) / samples_) / s;
}

}  // namespace shapeid::experiments
