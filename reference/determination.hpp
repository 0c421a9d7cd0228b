// Which parameters the data determine, and which come from the shapes and the density term.
// Derivation: docs/derivations/determination.md.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace shapeid::reference {

/// Rows of one contiguous block of time, already weighted and free of contact forces.
struct RowBlock {
  Eigen::MatrixXd rows;  ///< [Y F], a triangle
};

/// Per parameter of the free links (10 each).
struct Determination {
  /// Plain least squares, without shapes or bounds, in the parameter's unit; where the data say
  /// nothing, that of the shortest Phi in natural sizes.
  Eigen::VectorXd value;
  /// Standard error of plain least squares, without shapes or bounds, in the parameter's unit.
  /// Infinite where the data say nothing, and where a single block says most of it, so that no
  /// spread tells how well. Allows for autocorrelation within a block.
  Eigen::VectorXd standard_error;
  /// The error, widened for few blocks, is below `largest_share` of the size that the shapes could
  /// give the parameter.
  std::vector<bool> determined;
  int rank = 0;  ///< directions of parameter space that the rows reach
  /// Factor by which an interval of two standard errors is widened for few blocks (Student's t).
  double wider = 1.0;
  Eigen::VectorXd natural_size;  ///< as determine() was given it

  /// What rounding may make of the parameter, in its unit. Of data without noise the standard error
  /// is smaller than that: blocks may round alike.
  [[nodiscard]] double rounding(Eigen::Index parameter) const {
    constexpr double of_size = 1e-12;  // thousands of roundings
    return of_size * natural_size[parameter];
  }

  /// Whether a number of this parameter lies within three of its widened errors from `value`, or
  /// within rounding.
  [[nodiscard]] bool agrees(Eigen::Index parameter, double number) const {
    return std::abs(number - value[parameter]) <=
           std::max(3.0 * wider * standard_error[parameter], rounding(parameter));
  }

  /// Whether `value` is no body's: a mass, or a moment of inertia, that is negative by more than
  /// that. Noise in the motion makes such values of links that hardly turn.
  [[nodiscard]] bool is_impossible(Eigen::Index parameter) const;
};

/// Whether the values of a parameter by two filters of the same data differ by more than two
/// widened errors of either, and by more than rounding. They share their noise of torque, so that
/// chance makes less.
[[nodiscard]] bool differ(const Determination& a, const Determination& b, Eigen::Index parameter);

/// Whether shapes and bounds hold a number to which they leave `standard_error`, where the data by
/// themselves have another: it then follows less than half of what the data say by chance.
[[nodiscard]] bool is_held(double standard_error, double data_standard_error);

/// A parameter whose error exceeds half of its own natural size is not known even to its sign.
inline constexpr double largest_share = 0.5;

/// The spread of answers that each miss one block (jackknife), of plain least squares by
/// Phi = (Y^T Y)^+ Y^T F: variance (K - 1) / K sum_k d_k^2 with
/// d_k = (Y^T Y - Y_k^T Y_k)^-1 Y_k^T (Y_k Phi - F_k) (Bell, McCaffrey 2002; within 1 / K of that
/// around the answers' mean). The sandwich of the residuals as they are (Liang, Zeger 1986)
/// misses directions determined by a single block, whose residual is zero there.
/// `natural_size`: for each parameter the size it could have, in its unit; positive. It scales the
/// columns, so that rank and shares do not depend on units.
[[nodiscard]] Determination determine(const std::vector<RowBlock>& blocks,
                                      const Eigen::VectorXd& natural_size);

/// Takes back that parameters are determined: those with a value that no body has, and those of
/// which rows behind a slower filter (`slower`) say so much else that the difference, as part of
/// the error, is more than `largest_share` allows.
void take_back(Determination& data, const std::optional<Determination>& slower);

}  // namespace shapeid::reference
