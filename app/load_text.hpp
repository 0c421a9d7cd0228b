// A load's mass, place and inertia, as JSON and as text.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/app/result.hpp"

namespace shapeid::app {

/// The same load behind another filter, which leaves more of the motion's peaks and noise.
struct LoadElsewhere {
  double cutoff = 0.0, row_cutoff = 0.0;  ///< Hz
  double mass = 0.0, error = 0.0;         ///< kg: the load's, and its standard error
};

/// A note if the two masses differ by more than their standard errors say; empty else.
[[nodiscard]] std::string filter_note(const Result& result, const LoadElsewhere& other);

/// What the data say of the load by themselves, without the area and masses of zero or more, where
/// it is for certain no load in the area: a mass below zero, a centre outside. And what is odd
/// about the load that was found: too small to be told from none, heavier than the robot, or than
/// robot.yaml says.
/// `expected_mass`: kg.
[[nodiscard]] std::vector<std::string> load_notes(const Result& result, const RobotInputs& robot,
                                                  double expected_mass);

/// Throws Refusal ("no-mass") if the data ask for a load so far below zero that with it next to
/// nothing, or less, would be left of the whole robot.
void check_some_weight(const Result& result, const Robot& robot);

/// mass (kg), centre (m, link frame), tensor about the centre (kg m^2: Ixx Ixy Ixz Iyy Iyz Izz).
[[nodiscard]] nlohmann::json load_json(const Result& result, const Robot& robot,
                                       const std::optional<LoadElsewhere>& other);
[[nodiscard]] std::string load_text(const Result& result, const Robot& robot);

}  // namespace shapeid::app
