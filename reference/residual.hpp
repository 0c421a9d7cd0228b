// What the dynamics leave unexplained, seen at the joints: the yardstick of every comparison.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/reference/window.hpp"

namespace shapeid::reference {

/// P (Y Phi - S^T tau) in generalised order: predicted minus logged force, after the part that
/// contact forces could explain is taken out (P = I - J^T (J^T)^+) or, with measured forces, moved
/// over (4). `Phi`: 10 per link of the robot.
[[nodiscard]] Eigen::VectorXd residual(const Robot& robot, const Sample& sample,
                                       const Eigen::VectorXd& Phi, ContactTreatment contacts);

/// Root mean square of the residual of several models over the same samples, row by row.
class ResidualTable {
 public:
  ResidualTable(const Robot& robot, ContactTreatment contacts, std::vector<Eigen::VectorXd> models);

  void add(const Sample& sample);
  [[nodiscard]] std::size_t samples() const { return samples_; }
  /// Root mean square, dof x models; zero without samples.
  [[nodiscard]] Eigen::MatrixXd rms() const;

 private:
  const Robot* robot_;
  ContactTreatment contacts_;
  std::vector<Eigen::VectorXd> models_;
  Eigen::MatrixXd squares_;
  std::size_t samples_ = 0;
};

}  // namespace shapeid::reference
