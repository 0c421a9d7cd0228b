// Joints whose zero is not the model's: another convention, a quarter or half a turn away.
#pragma once

#include "shapeid/diagnosis/recording.hpp"
#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/robot.hpp"

namespace shapeid::diagnosis {

/// Refusal `joint-zero` if some revolute joints of a robot on a fixed base should be read a quarter
/// or half a turn further: the given links then predict the logged torque well, far better than as
/// it is, and better than with the base on its side. Masses that are fitted would hide it: they may
/// lie anywhere about the axis.
void check_joint_zeros(const Robot& robot, const Recording& recording, ContactTreatment contacts);

}  // namespace shapeid::diagnosis
