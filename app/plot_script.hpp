// What gnuplot scripts of a diagnosis's pictures have in common.
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>

#include <string>

#include "shapeid/app/ticks.hpp"

namespace shapeid::app {

/// Of what was logged, of the given model, of what was found.
inline constexpr const char* grey = "#8a8a8a";
inline constexpr const char* orange = "#d9822b";
inline constexpr const char* blue = "#1f5fa8";
inline constexpr int plot_width = 820;  ///< pixels, of pictures as wide as the page

/// The beginning of a script: a picture of so many pixels.
[[nodiscard]] std::string canvas(int width, int height);

/// The range of an axis and ticks on it with room for their labels.
[[nodiscard]] std::string x_axis(const Span& span, double pixels);

/// Columns of numbers under a name that plot commands can use.
template <typename Row>
[[nodiscard]] std::string data_rows(const std::string& name, Eigen::Index rows, const Row& row) {
  std::string block = fmt::format("${} << EOD\n", name);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (const double x : row(i)) block += fmt::format("{:.5g} ", x);
    block += "\n";
  }
  return block + "EOD\n";
}

}  // namespace shapeid::app
