// Pictures of a division, drawn by gnuplot as SVG.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/body_model.hpp"

namespace shapeid::app {

/// The shapes seen from above (x to the right, y up, m of the link's frame), each as its bounding
/// rectangle, darker the denser; overlapping shapes add up along z. A cross marks `truth`, if
/// given, a circle the centre of the found mass.
[[nodiscard]] std::string division_picture(const BodyModel& model, const Eigen::VectorXd& masses,
                                           const std::optional<Eigen::Vector3d>& truth);

/// What a run of divisions did, one entry after each solve, the undivided one first.
struct DivisionTrace {
  std::vector<double> objective;
  std::vector<double> mass_error;   ///< kg, against the truth
  std::vector<double> place_error;  ///< m
  std::vector<double> seconds;      ///< since the undivided problem was solved
};

/// Objective, errors and time against the number of divisions, one under the other.
[[nodiscard]] std::string trace_picture(const DivisionTrace& trace);

}  // namespace shapeid::app
