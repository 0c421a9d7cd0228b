// How large a robot is, to tell metres from millimetres.
#pragma once

#include <optional>
#include <string>

#include "shapeid/models/robot.hpp"

namespace shapeid {

/// m: the longest way from the base through joints' origins to a centre of mass, and the radius of
/// gyration beyond it, or to a frame that is fixed to a link; sliding joints at the ends of their
/// travel.
[[nodiscard]] double size_of(const Robot& robot);

/// Empty if a point so far (m) from its link's origin may belong to the robot, else what it is
/// instead: "110 m from the link's origin, on a robot of 0.8 m". Thirty times the robot's size is
/// too far; of a robot without any size nothing is.
[[nodiscard]] std::optional<std::string> why_too_far(double distance, const Robot& robot);

}  // namespace shapeid
