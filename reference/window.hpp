// Equations (4)-(5): the weighted rows of many samples, one under the other.
#pragma once

#include <Eigen/Core>

#include <cstddef>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/mass_problem.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/reference/sample_rows.hpp"

namespace shapeid::reference {

/// Collects rows of the free links. The rows are kept as they are up to a limit, then reduced by QR
/// to a triangle that has the same normal equations and the same minimum (rows = columns + 1), so
/// that a log of any length fits.
class Window {
 public:
  /// `weight`: diagonal of W in generalised order, 1 / sigma^2. The robot must outlive the window.
  Window(const Robot& robot, const BodyModel& model, ContactTreatment contacts,
         Eigen::VectorXd weight);

  void add(const Sample& sample);
  /// The same with the sample's rows given, not weighted yet and with contact forces in them.
  void add(const SampleRows& rows);
  /// One instant's rows, weighted and free of contact forces already, e.g. a RowFilter's.
  void add_rows(const Eigen::MatrixXd& Y, const Eigen::VectorXd& F);
  void clear();

  [[nodiscard]] std::size_t samples() const { return samples_; }
  /// Rows of the free links: Y, rows x (10 per free link), and F with the known links moved over.
  [[nodiscard]] Eigen::MatrixXd Y() const;
  [[nodiscard]] Eigen::VectorXd F() const;

  /// The mass problem (15) of these rows and the shapes of `model`, which has the free links that
  /// the window was made for. W is one, since weights are already in the rows; lambda and
  /// mass_bound are zero, for the caller to set.
  [[nodiscard]] MassProblem problem(const BodyModel& model) const;

 private:
  void reduce();

  const Robot* robot_;
  ContactTreatment contacts_;
  Eigen::VectorXd weight_;
  Eigen::VectorXd known_;
  std::vector<int> free_links_;
  Eigen::MatrixXd rows_;  ///< [Y F], the first used_ rows count
  Eigen::Index used_ = 0;
  std::size_t samples_ = 0;
};

}  // namespace shapeid::reference
