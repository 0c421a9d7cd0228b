// Calls gnuplot.
#pragma once

#include <string>

namespace shapeid::app {

/// Throws InputError if there is no gnuplot: before the work whose report it is to draw.
void check_gnuplot();

/// The SVG element that a gnuplot script draws. Throws InputError if gnuplot is missing, Defect if
/// it refuses the script.
[[nodiscard]] std::string gnuplot(const std::string& script);

/// `text` as a string of such a script, quotes and all: nothing in it is a command, whatever a URDF
/// or a log calls its joints and columns.
[[nodiscard]] std::string gnuplot_string(const std::string& text);

/// `text` as an entry of a data block.
[[nodiscard]] std::string gnuplot_entry(const std::string& text);

}  // namespace shapeid::app
