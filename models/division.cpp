#include "shapeid/models/division.hpp"

#include <cmath>

namespace shapeid {

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
