// Joints whose zero or sign is not the model's: another convention.
#pragma once

#include "shapeid/diagnosis/recording.hpp"
#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/robot.hpp"

namespace shapeid::diagnosis {

/// By the given links: masses that are fitted would hide it, for they may lie anywhere about the
/// axis. On a fixed base they predict the logged torque well if some joints are read otherwise, far
/// better than as it is, and better than with the base on its side; on a floating one clearly
/// better, part by part of the log. Throws Refusal:
///  * "joint-sign": position, torque or both of some joint have the other sign;
///  * "joint-zero": on a fixed base revolute joints should be read a quarter or half a turn
///    further, and no sign is wrong.
void check_joint_readings(const Robot& robot, const Recording& recording,
                          ContactTreatment contacts);

/// On a floating base: what the given links leave (GivenErrors) with the joints read as that would
/// say, or as logged if it would say nothing.
[[nodiscard]] double left_by_other_signs(const Robot& robot, const Recording& recording,
                                         ContactTreatment contacts);

}  // namespace shapeid::diagnosis
