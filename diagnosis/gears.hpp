// A gear between the motor, where the encoder sits, and the joint. In no catalogue: what it changes
// follows the load, and no model here predicts torque from a motion that torque has changed.
#pragma once

#include "shapeid/diagnosis/effect.hpp"

namespace shapeid::diagnosis {

/// The joint stands and accelerates otherwise than the encoder says, by d and a. What Signal::yield
/// and Signal::play make laws of: a gear that gives way by c tau, or by g on the side that drives,
/// has the joint at q - c tau, and its acceleration at that of q less c d^2 tau / dt^2.
[[nodiscard]] const Effect& motor_ahead();

}  // namespace shapeid::diagnosis
