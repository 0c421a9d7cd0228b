// Equation (16) and Algorithm 1: what can be chosen about a division run, and what it reports.
#pragma once

#include <Eigen/Core>

#include <string>

#include "shapeid/models/contract.hpp"
#include "shapeid/models/mass_problem.hpp"

namespace shapeid {

/// A part that came about by this many cuts is not cut any further: it has 1e-12 of its shape's
/// volume, and its position inside the shape no longer affects the moments. Without a limit a
/// criterion that prefers dense shapes would cut one and the same until rounding forbids it.
inline constexpr int most_cuts = 40;

/// Cuts go across the longest side: after so many a part of a cuboid has about a sixteenth of each.
/// What moves inside of it is little whatever the motion excites, so that a small step says that
/// the divided part is small, not that the cut went where the motion sees nothing.
inline constexpr int settled_cuts = 12;

/// Equation (16), scaled to be free of units: v = k1 (m/M0)(V/V0) + k2 (m/M0)/(V/V0).
struct DivisionOptions {
  double k1 = 1.0;     ///< weight of large heavy shapes
  double k2 = 1e-4;    ///< weight of dense shapes
  double step = 1e-3;  ///< eps: stop when every group of the step is below eps of its size
  int patience = 3;    ///< ... this many divisions in a row, and no plateau (is_near_floor())
  int most_divisions = 100;
  double tie = 1e-9;           ///< relative: v this close count as equal, the smallest place wins
  double expected_mass = 0.0;  ///< M0 > 0, kg; fixed before the first division
};

/// One division: what was cut, and what the next solve gave.
struct DivisionStep {
  std::string divided;     ///< id of the shape that was cut
  double criterion = 0.0;  ///< its v
  double objective_before = 0.0, objective_at_split = 0.0, objective_after = 0.0;
  /// || Phi_k - Phi_(k-1) || per group, relative to the group's size: mass, first moment, tensor.
  /// A first moment's size is sqrt(mass x tensor), which bounds it wherever the origin lies.
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  int iterations = 0;
  int shapes = 0;  ///< after this division
};

/// Whether divisions that stop here leave little to be had. `floor`: under the data term however
/// finely the shapes are divided; `undivided`: the objective of the shapes as given. Little is a
/// hundredth of what there was, or a ten-thousandth of the objective.
[[nodiscard]] bool is_near_floor(double undivided, const Objective& now, double floor);

/// Empty if the options make sense; the reason otherwise.
[[nodiscard]] Violation why_senseless(const DivisionOptions& options);

}  // namespace shapeid
