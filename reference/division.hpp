// Equation (16) and Algorithm 1: divide the shape with the largest v, solve again, warm-started.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/mass_problem.hpp"

namespace shapeid::reference {

/// Equation (16), scaled to be free of units: v = k1 (m/M0)(V/V0) + k2 (m/M0)/(V/V0).
struct DivisionOptions {
  double k1 = 1.0;     ///< weight of large heavy shapes
  double k2 = 1e-4;    ///< weight of dense shapes
  double step = 1e-3;  ///< eps: stop when every group of the step is below eps of its size
  int patience = 3;    ///< ... this many divisions in a row
  int most_divisions = 100;
  double tie = 1e-9;           ///< relative: v this close count as equal, the smallest place wins
  double expected_mass = 0.0;  ///< M0, kg; fixed before the first division
};

/// One division: what was cut, and what the next solve gave.
struct DivisionStep {
  std::string divided;     ///< id of the shape that was cut
  double criterion = 0.0;  ///< its v
  double objective_before = 0.0, objective_at_split = 0.0, objective_after = 0.0;
  /// || Phi_k - Phi_(k-1) || per group, relative to the group's size: mass, first moment, tensor.
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  int iterations = 0;
  int shapes = 0;  ///< after this division
};

struct DivisionRun {
  BodyModel model;      ///< with the divided shapes
  MassProblem problem;  ///< the last problem: same rows and lambda, more columns
  MassSolution solution;
  std::vector<DivisionStep> history;
  std::string stopped_by;  ///< "step", "limit", "nothing divisible"
};

/// v of every shape (zero for shapes that cannot be divided).
[[nodiscard]] Eigen::VectorXd division_criterion(const BodyModel& model, const Eigen::VectorXd& m,
                                                 const DivisionOptions& options);

/// Algorithm 1 from an undivided model. `watch` (may be empty) is called after every division.
[[nodiscard]] DivisionRun divide_and_solve(
    const BodyModel& model, const MassProblem& problem, const DivisionOptions& options,
    const std::function<void(const DivisionRun&)>& watch = {});

}  // namespace shapeid::reference
