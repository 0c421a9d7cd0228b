#include "shapeid/models/division.hpp"

#include <algorithm>
#include <cmath>

namespace shapeid {

bool is_near_floor(double undivided, const Objective& now, double floor) {
  constexpr double of_gain = 1e-2, of_rest = 1e-4;
  // The density term, which no floor contains, is not there to be gained.
  return now.data - floor <= std::max(of_gain * (undivided - floor), of_rest * now.total());
}

Violation why_senseless(const DivisionOptions& options) {
  if (!(options.expected_mass > 0.0 && std::isfinite(options.expected_mass))) {
    return "the expected mass M0 must be positive and finite";
  }
  const double weights = options.k1 + options.k2;
  if (!(options.k1 >= 0.0 && options.k2 >= 0.0 && weights > 0.0 && std::isfinite(weights))) {
    return "k1 and k2 must be finite, not negative, nor both zero";
  }
  if (!(options.step >= 0.0) || !(options.tie >= 0.0 && options.tie < 1.0) ||
      options.patience < 1 || options.most_divisions < 0) {
    return "division needs eps >= 0, 0 <= tie < 1, patience >= 1, most divisions >= 0";
  }
  return std::nullopt;
}

}  // namespace shapeid
