// gnuplot scripts of curves.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace shapeid::experiments {

struct Curve {
  std::string title;
  std::vector<std::pair<double, double>> points;
};

struct Panel {
  std::string x, y;  ///< axis labels with units
  std::vector<Curve> curves;
  std::string settings;  ///< more gnuplot commands, each ended by a newline
};

/// The panels one under the other, with one key beside each. Without terminal and output, which the
/// writer of the page adds.
[[nodiscard]] std::string plot(const std::vector<Panel>& panels);

/// Pixels that a script of plot() needs.
[[nodiscard]] int picture_height(const std::string& script);

}  // namespace shapeid::experiments
