// Claims C4, C5. Equation (16) and Algorithm 1: divide the shape with the largest v, solve again,
// warm-started. Derivation, and the reasons for the defaults: docs/derivations/division.md.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/division.hpp"
#include "shapeid/models/mass_problem.hpp"

namespace shapeid::reference {

struct DivisionRun {
  BodyModel model;      ///< with the divided shapes
  MassProblem problem;  ///< the last problem: same rows and lambda, more columns
  MassSolution solution;
  std::vector<DivisionStep> history;
  std::string stopped_by;  ///< "step", "limit", "nothing divisible"
};

/// v of every shape (zero for shapes that cannot be divided). m in kg, one a shape. V0 is the
/// volume of all shapes, which no division changes.
[[nodiscard]] Eigen::VectorXd division_criterion(const BodyModel& model, const Eigen::VectorXd& m,
                                                 const DivisionOptions& options);

/// The place whose shape is divided next: the largest v, or the smallest place among those within
/// the tie. -1 if no v is positive: then no divisible shape carries mass.
[[nodiscard]] Eigen::Index next_to_divide(const Eigen::VectorXd& v, double tie);

/// A model with one shape cut in two, its problem, and where the next solve starts.
struct Split {
  BodyModel model;
  MassProblem problem;
  Eigen::VectorXd start;  ///< m1 = m V1/V, m2 = m V2/V: the same density on both sides of the cut
};

/// Cuts the shape at `place`. The first part ("3.0") takes its place, the second ("3.1") is
/// appended, so that every other shape keeps its place. None of a shape that cannot be cut
/// (parts_if_any()).
[[nodiscard]] std::optional<Split> split_shape(const BodyModel& model, const MassProblem& problem,
                                               const Eigen::VectorXd& m, Eigen::Index place);

/// Empty if the problem's columns and volumes are those of the model's shapes.
[[nodiscard]] Violation why_unrelated(const BodyModel& model, const MassProblem& problem);

/// Empty if Phi, the data term and the density term are what they were before the split, to within
/// rounding.
[[nodiscard]] Violation why_changed(const MassProblem& before, const Eigen::VectorXd& m,
                                    const Split& after);

/// Algorithm 1 from an undivided model, whose columns and volumes are the problem's. `watch` (may
/// be empty) is called after the first solve and after every division. Only the objective
/// converges; a small step proves no optimality: where `floor` is given, small steps end the run
/// only near it (is_near_floor()) or in parts that have been cut settled_cuts times. It is asked
/// once, if at all; what it answers is to hold for every later division. Throws
/// std::invalid_argument for options that make no sense.
[[nodiscard]] DivisionRun divide_and_solve(
    const BodyModel& model, const MassProblem& problem, const DivisionOptions& options,
    const std::function<void(const DivisionRun&)>& watch = {},
    const std::function<double(const DivisionRun&)>& floor = {});

}  // namespace shapeid::reference
