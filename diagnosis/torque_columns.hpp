// Torque columns that are not what the robot's joints feel: of another unit, sign or joint.
#pragma once

#include "shapeid/diagnosis/recording.hpp"
#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/robot.hpp"

namespace shapeid::diagnosis {

/// By what the given links predict. Throws Refusal:
///  * "torque-sign", "torque-scale": of joints whose torque follows the prediction, all have the
///    other sign, or all are less than a quarter or more than four times of it;
///  * "torque-order": two joints follow each other's prediction, far better than their own.
void check_torque_columns(const Robot& robot, const Recording& recording,
                          ContactTreatment contacts);

}  // namespace shapeid::diagnosis
