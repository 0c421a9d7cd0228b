// Masses of divided shapes, by either path.
#pragma once

#include <Eigen/Core>

#include "shapeid/diagnosis/rigid_rows.hpp"
#include "shapeid/models/body_model.hpp"
#include "shapeid/models/division.hpp"
#include "shapeid/models/mass_problem.hpp"

namespace shapeid::diagnosis {

/// Algorithm 1 on a problem, and its shapes' masses for other rows. Throws Refusal "declined" where
/// the fast path was asked for and declines.
class ShapeMasses {
 public:
  /// `problem`: of the undivided shapes of `shapes`, W of ones.
  ShapeMasses(const BodyModel& shapes, MassProblem problem, const DivisionOptions& options,
              Path path);

  /// 10 per free link.
  [[nodiscard]] const Eigen::VectorXd& Phi() const { return Phi_; }
  /// Of the shapes as they are divided, for rows [Y F] in the place of the problem's; the masses
  /// so far are the start.
  [[nodiscard]] Eigen::VectorXd Phi_of(const Eigen::MatrixXd& Y, const Eigen::VectorXd& F) const;

 private:
  void divide_fast(const BodyModel& shapes, const DivisionOptions& options);

  Path path_;
  MassProblem problem_;  ///< of the shapes as they are divided
  Eigen::VectorXd m_, Phi_;
};

}  // namespace shapeid::diagnosis
