#pragma once

namespace shapeid {

/// As in CMakeLists.txt; a test compares the two.
inline constexpr const char* version = "0.1.0";

}  // namespace shapeid
