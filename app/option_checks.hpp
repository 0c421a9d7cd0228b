// What numbers among the options must be, refused in one line.
#pragma once

#include <CLI/CLI.hpp>

namespace shapeid::app {

/// A finite number above zero.
[[nodiscard]] CLI::Validator above_zero();
/// A finite number, zero or above.
[[nodiscard]] CLI::Validator zero_or_above();

}  // namespace shapeid::app
