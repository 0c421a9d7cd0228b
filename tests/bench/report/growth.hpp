// How the time of one more division grows with the number of shapes.
#pragma once

#include <string>

#include "shapeid/tests/bench/report/results.hpp"

namespace shapeid::bench {

/// The exponent p of t ~ n^p, t the time of a division at n shapes: the slope of a line through
/// (log n, log t), least squares. t comes from the differences between runs of different lengths,
/// "divisionN<set>/<solver>/solve", whose n lie between the two bounds. `points`: how many.
struct Growth {
  double exponent = 0.0;
  int points = 0;
};
[[nodiscard]] Growth growth(const Results& results, const std::string& set,
                            const std::string& solver, double from, double to);

}  // namespace shapeid::bench
