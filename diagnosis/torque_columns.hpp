// Torque columns that are not what the robot's joints feel: of another unit, sign or joint, or
// dead.
#pragma once

#include <vector>

#include "shapeid/diagnosis/recording.hpp"
#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/robot.hpp"

namespace shapeid::diagnosis {

/// Joints that move, and whose torque is zero in every row of a log that has others. (A brake holds
/// what stands still.)
[[nodiscard]] std::vector<int> silent_joints(const Robot& robot, const Recording& recording);

/// A torque of zero in every row is right of a joint that nothing drives: what its link's own
/// acceleration takes is what gravity and the other joints give. Throws Refusal "torque-missing" if
/// that is not so of a joint that moves, by the given links.
void check_silent_torques(const Robot& robot, const Recording& recording,
                          ContactTreatment contacts);

/// By what the given links predict. Throws Refusal:
///  * "torque-sign", "torque-scale": of joints whose torque follows the prediction, all have the
///    other sign, or all are less than a quarter or more than four times of it;
///  * "torque-order": two joints follow each other's prediction, far better than their own.
void check_torque_columns(const Robot& robot, const Recording& recording,
                          ContactTreatment contacts);

}  // namespace shapeid::diagnosis
