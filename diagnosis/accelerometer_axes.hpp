// An accelerometer whose axes are not the base's.
#pragma once

#include "shapeid/diagnosis/recording.hpp"
#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/robot.hpp"

namespace shapeid::diagnosis {

/// Throws Refusal "imu-axes" if the given links of a floating base would predict the logged torque
/// far better, and well, if the accelerometer's axes were exchanged or had other signs.
/// (Of the gyro that can be seen without any inertia: reference/standing_feet.hpp.)
void check_accelerometer(const Robot& robot, const Recording& recording, ContactTreatment contacts);

}  // namespace shapeid::diagnosis
