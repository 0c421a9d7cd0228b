// The whole circle: C++17, which Simbody's headers are, has no numbers.
#pragma once

namespace shapeid {

inline constexpr double two_pi = 6.283185307179586;

}  // namespace shapeid
