// What identifiers of windows ask of the numbers that they are given, whichever path they take.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/robot.hpp"

namespace shapeid {

/// Samples of a window or stride, at most. (A negative number in C comes as more.)
inline constexpr std::size_t longest_window = 1'000'000'000;

struct OnlineNumbers {
  std::size_t window, stride;    ///< samples
  double alpha;                  ///< equation (17)
  double expected_mass;          ///< kg
  std::optional<double> lambda;  ///< of the mass problem
};

/// Throws InputError for numbers that make no sense.
void check_online(const OnlineNumbers& numbers);

/// Throws InputError unless the robot is well-formed, the model is this robot's with finite known
/// parameters, and what it seeks moves.
void check_sought(const Robot& robot, const BodyModel& model);

/// The diagonal of W, ones where none is given. Throws InputError unless there is a positive number
/// for each of the robot's `dof` equations, all within twelve decades of each other: beyond that
/// rounding of one equation is more than all of another (docs/derivations/projection.md).
[[nodiscard]] Eigen::VectorXd online_weight(const Eigen::VectorXd& given, Eigen::Index dof);

/// || b ||^2 of a window in which all generalised forces are the weight of all links, the free ones
/// as expected (torques: that weight at a metre). `weight`: online_weight().
[[nodiscard]] double squares_of_weight(const BodyModel& model, double expected_mass,
                                       std::size_t window, const Eigen::VectorXd& weight);

/// Share of that from which on a window gives lambda a scale: forces of a thousandth of the weight.
/// What noise makes of drives that are off is less, and would leave masses that no row tells apart
/// to rounding.
inline constexpr double least_share_of_weight = 1e-6;

}  // namespace shapeid
