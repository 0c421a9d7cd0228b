// The smallest and the largest of some values.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace shapeid {

/// What is no number is left out. Of no value it is empty, and its width minus infinity.
struct ValueRange {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  void add(double value) {
    if (std::isnan(value)) return;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  [[nodiscard]] double width() const { return most - least; }
};

}  // namespace shapeid
