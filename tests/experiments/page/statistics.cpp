#include "shapeid/tests/experiments/page/statistics.hpp"

#include <algorithm>
#include <numeric>

namespace shapeid::experiments {

Spread spread(std::vector<double> numbers) {
  std::sort(numbers.begin(), numbers.end());
  const std::size_t n = numbers.size(), half = n / 2;
  const double middle = n % 2 == 1 ? numbers[half] : 0.5 * (numbers[half - 1] + numbers[half]);
  return {numbers.front(), middle, numbers.back()};
}

double mean(const std::vector<double>& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), 0.0) / static_cast<double>(numbers.size());
}

}  // namespace shapeid::experiments
