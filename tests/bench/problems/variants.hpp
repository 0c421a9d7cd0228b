// The variants that every set of problems comes in.
#pragma once

#include <string>
#include <vector>

#include "shapeid/tests/bench/problems/dense_problem.hpp"
#include "shapeid/tests/bench/problems/trot.hpp"

namespace shapeid::bench {

struct Variant {
  std::string suffix;  ///< of the row's name
  Noise noise;
  Density density;
};

[[nodiscard]] inline std::vector<Variant> variants() {
  return {{"", Noise::sensors, Density::none},
          {"_noisefree", Noise::none, Density::none},
          {"_density", Noise::sensors, Density::design}};
}

}  // namespace shapeid::bench
