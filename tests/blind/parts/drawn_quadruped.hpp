// Quadrupeds that nobody chose: one for each seed, with the plan of most and sizes of their own.
#pragma once

#include <cstdint>

#include "shapeid/tests/blind/parts/machine.hpp"

namespace shapeid::blind {

/// Four equal legs, the left ones mirrored, with abduction, hip and knee, on a base of 3.5 to 8 kg;
/// knees behind or before, frames of links turned by quarters, joints that count either way, the
/// IMU at any place and mounted any way round. Gait, rate, filter and noise are drawn, too. Not
/// every one can walk: such a trial says that it fell.
[[nodiscard]] Machine drawn_quadruped(std::uint64_t seed);

}  // namespace shapeid::blind
