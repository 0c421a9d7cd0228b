// One simulated trot, cut into logs of unequal length.
#pragma once

#include <string>

namespace shapeid::test {

inline constexpr int pieces = 7;

/// Names in scratch() of the pieces, parted by blanks. Each begins a second later than the rows
/// say, so that the same pieces one behind the other are one log with gaps.
[[nodiscard]] const std::string& piece_names();

/// Name in scratch() of that one log.
[[nodiscard]] const std::string& whole_name();

}  // namespace shapeid::test
