// The mean of some values.
#pragma once

#include <cstddef>

namespace shapeid {

/// Of no value it is zero.
struct Mean {
  double sum = 0.0;
  std::size_t count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  [[nodiscard]] double value() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
};

}  // namespace shapeid
