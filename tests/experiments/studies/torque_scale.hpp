// A load on the base and a common scale of all torques, fitted together.
#pragma once

#include <vector>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/tests/experiments/methods/data_term.hpp"

namespace shapeid::experiments {

/// Rows of  Y Phi + known - s tau,  contact forces projected out, W = 1, for any scale s of the
/// logged torques: true torque = s x logged.
class ScaledRows {
 public:
  ScaledRows(const Robot& robot, const BodyModel& model, const std::vector<Sample>& samples);

  /// || (Y Phi + known) / s - tau ||^2 times s^2 as a data term of Phi.
  [[nodiscard]] DataTerm at(double s) const;
  /// Root mean square over the samples of || (Y Phi + known) / s - tau ||, N m (and N): in the
  /// log's units, so that a small s cannot shrink it.
  [[nodiscard]] double rms(double s, const Vector10& Phi) const;

 private:
  Eigen::MatrixXd R_;  ///< triangle of [Y known tau], 12 columns
  double samples_;
};

}  // namespace shapeid::experiments
