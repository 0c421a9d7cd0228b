// A log that asks for no mass where some is sought.
#pragma once

namespace shapeid::app {

/// Of what is expected: what bounds that are active leave, or shapes a thousand times too large.
inline constexpr double share_of_no_mass = 1e-3;

/// Of the refusal "no-mass", behind what was seen.
inline constexpr const char* causes_of_no_mass =
    "the sign of the torques or of the accelerometer is wrong, the given inertias are too large, "
    "what carries the robot is no contact of it, or lengths of shapes or contacts are no metres";

}  // namespace shapeid::app
