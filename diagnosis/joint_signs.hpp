// Joints of another sign, told by a log without given inertias.
#pragma once

#include "shapeid/diagnosis/loop.hpp"

namespace shapeid::diagnosis {

/// Of the logs that are fitted, on a fixed base. Throws Refusal "joint-sign" if masses that are
/// fitted predict held-out blocks far better, block by block, where position, torque or both of
/// some joint have the other sign: what check_joint_readings() cannot tell of a robot whose
/// inertias are not known. A joint whose friction is most of its torque tells nothing so, and of a
/// zero that is elsewhere masses say nothing. "too-short" if there are too few blocks.
void check_joint_signs(const Robot& robot, const Recording& recording,
                       const LoopSettings& settings);

}  // namespace shapeid::diagnosis
