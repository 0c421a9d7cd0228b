// Arms that nobody chose: one for each seed, as different as arms are.
#pragma once

#include <cstdint>

#include "shapeid/tests/blind/parts/machine.hpp"

namespace shapeid::blind {

/// Two to six joints, one of eight of them a slider, about axes and at places of any direction, on
/// a base that stands, hangs or leans; links of 0.2 to 8 kg; rate, filter, noise and how fast it
/// moves are drawn, too.
[[nodiscard]] Machine drawn_arm(std::uint64_t seed);

}  // namespace shapeid::blind
