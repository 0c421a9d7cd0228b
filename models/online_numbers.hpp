// What identifiers of windows ask of the numbers that they are given, whichever path they take.
#pragma once

#include <cstddef>
#include <optional>

namespace shapeid {

struct OnlineNumbers {
  std::size_t window, stride;    ///< samples
  double alpha;                  ///< equation (17)
  double expected_mass;          ///< kg
  std::optional<double> lambda;  ///< of the mass problem
};

/// Throws InputError for numbers that make no sense.
void check_online(const OnlineNumbers& numbers);

}  // namespace shapeid
