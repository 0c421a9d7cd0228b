// Legs whose columns are exchanged.
#pragma once

#include "shapeid/diagnosis/recording.hpp"
#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/robot.hpp"

namespace shapeid::diagnosis {

/// Throws Refusal "leg-order" if the given links predict the logged torque better, part by part of
/// the log, with the columns of legs exchanged that have the same joints: positions, torques,
/// contacts and forces. Of four such legs all orders are tried, of more all pairs. Legs that move
/// alike tell nothing. Where other axes of the accelerometer are told as well, "imu-axes".
void check_leg_order(const Robot& robot, const Recording& recording, ContactTreatment contacts);

}  // namespace shapeid::diagnosis
