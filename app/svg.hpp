// What an SVG of gnuplot needs before it may stand in a page beside others.
#pragma once

#include <string>

namespace shapeid::app {

/// The SVG without its <title> elements: gnuplot puts its own commands there, which a browser shows
/// as tooltips.
[[nodiscard]] std::string without_titles(const std::string& svg);

/// The SVG with `prefix` before every id that something in it refers to, and before these
/// references (href="#...", url(#...)); other ids are left out. In one page an id may be there only
/// once, and gnuplot gives every picture the same ones.
[[nodiscard]] std::string with_own_ids(const std::string& svg, const std::string& prefix);

}  // namespace shapeid::app
