// All thirteen links free at once, from a window long enough to excite them.
#pragma once

#include <vector>

#include "shapeid/tests/bench/problems/dense_problem.hpp"
#include "shapeid/tests/bench/problems/seeds.hpp"
#include "shapeid/tests/support/trot.hpp"

namespace shapeid::bench {

/// Every link of the quadruped as `count` cuboids: the bounds of its collision bodies, the largest
/// part halved until there are enough.
[[nodiscard]] BodyModel body_cuboids(int count);

/// Windows of two seconds, each 20 ms after the one before, one sequence after the other: 130 rows
/// once compressed. The problems are the published ones: W = 1, lambda = 0.
[[nodiscard]] std::vector<DenseProblem> body_windows(const BodyModel& model, SeedSet seeds,
                                                     test::Noise noise, Density density,
                                                     int sequences, int windows);

}  // namespace shapeid::bench
