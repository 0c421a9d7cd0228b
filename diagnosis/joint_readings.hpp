// Joints whose zero or sign is not the model's: another convention.
#pragma once

#include "shapeid/diagnosis/recording.hpp"
#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/robot.hpp"

namespace shapeid::diagnosis {

/// If some joints should be read otherwise, the given links then predict the logged torque well,
/// far better than as it is, and, on a fixed base, better than with the base on its side. Masses
/// that are fitted would hide it: they may lie anywhere about the axis. Throws Refusal:
///  * "joint-sign": position, torque or both of some joint have the other sign;
///  * "joint-zero": on a fixed base revolute joints should be read a quarter or half a turn
///    further, and no sign is wrong.
void check_joint_readings(const Robot& robot, const Recording& recording,
                          ContactTreatment contacts);

}  // namespace shapeid::diagnosis
