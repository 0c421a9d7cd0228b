// Medians and spreads of repeated trials.
#pragma once

#include <vector>

namespace shapeid::experiments {

struct Spread {
  double lowest = 0.0, median = 0.0, highest = 0.0;
};

/// At least one number.
[[nodiscard]] Spread spread(std::vector<double> numbers);
[[nodiscard]] double mean(const std::vector<double>& numbers);

}  // namespace shapeid::experiments
