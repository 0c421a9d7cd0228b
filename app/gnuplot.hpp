// Calls gnuplot.
#pragma once

#include <string>

namespace shapeid::app {

/// The SVG element that a gnuplot script draws. Throws InputError if gnuplot is missing or fails.
[[nodiscard]] std::string gnuplot(const std::string& script);

}  // namespace shapeid::app
