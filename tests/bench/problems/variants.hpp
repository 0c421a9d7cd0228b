// The variants that every set of problems comes in.
#pragma once

#include <string>
#include <vector>

#include "shapeid/tests/bench/problems/dense_problem.hpp"
#include "shapeid/tests/support/trot.hpp"

namespace shapeid::bench {

struct Variant {
  std::string suffix;  ///< of the row's name
  test::Noise noise;
  Density density;
};

[[nodiscard]] inline std::vector<Variant> variants() {
  return {{"", test::Noise::sensors, Density::none},
          {"_noisefree", test::Noise::none, Density::none},
          {"_density", test::Noise::sensors, Density::design}};
}

}  // namespace shapeid::bench
