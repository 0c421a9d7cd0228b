// Nonnegative masses of columns on one link, lambda = 0: the fast solver, and the reference where
// it declines.
#pragma once

#include <Eigen/Core>

#include "shapeid/fast/mass_solver.hpp"
#include "shapeid/models/body_model.hpp"
#include "shapeid/tests/experiments/methods/data_term.hpp"

namespace shapeid::experiments {

class MassColumns {
 public:
  /// The unit parameters of the model's shapes, and room for `more`.
  explicit MassColumns(const BodyModel& model, int more = 0);

  void append(const Vector10& u);
  /// Parameters at the minimum over the columns, from no masses.
  [[nodiscard]] Vector10 solve(const DataTerm& f);
  /// No nonnegative masses of these columns have an f below this. `Phi`: a guess of the optimum,
  /// the better the higher.
  [[nodiscard]] double floor(const DataTerm& f, const Vector10& Phi) const;
  [[nodiscard]] int size() const { return static_cast<int>(U_.cols()); }

 private:
  Eigen::MatrixXd U_;
  fast::MassSolver solver_;
};

/// [R c] over [0 d], as the fast solvers take it.
[[nodiscard]] Eigen::MatrixXd triangle_of(const DataTerm& f);

}  // namespace shapeid::experiments
