#include "shapeid/models/shape_size.hpp"

#include <fmt/format.h>

namespace shapeid {

Violation why_no_size(const Shape& shape) {
  constexpr double smallest = 1e-30, largest = 1e30;  // m^3
  const Moments m = moments(shape);
  if (!(m.volume >= smallest && m.volume <= largest)) {
    return fmt::format("has a volume of {:g} m^3", m.volume);
  }
  const bool finite = m.centroid.allFinite() && m.covariance.allFinite() &&
                      unit_parameters(shape).values.allFinite();
  return finite ? Violation() : Violation("has moments that are not finite");
}

}  // namespace shapeid
