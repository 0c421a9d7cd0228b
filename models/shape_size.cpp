#include "shapeid/models/shape_size.hpp"

#include <fmt/format.h>

namespace shapeid {

Violation why_no_size(const Shape& shape) {
  constexpr double smallest = 1e-30, largest = 1e30;  // m^3
  const Moments m = moments(shape);
  if (!(m.volume >= smallest && m.volume <= largest)) {
    return fmt::format("has a volume of {:g} m^3", m.volume);
  }
  const InertialParameters unit = unit_parameters(shape);
  if (!m.centroid.allFinite() || !m.covariance.allFinite() || !unit.values.allFinite()) {
    return "has moments that are not finite";
  }
  // Shells of a mesh that face inwards outside the others count as negative mass.
  if (const Violation why = why_impossible(unit)) {
    return fmt::format("is no body: {} (a shell of it that is inside out?)", *why);
  }
  return std::nullopt;
}

}  // namespace shapeid
