// The problems that a division run meets, recorded once, so that every solver gets the same ones.
#pragma once

#include <vector>

#include "shapeid/tests/bench/problems/dense_problem.hpp"
#include "shapeid/tests/bench/problems/seeds.hpp"
#include "shapeid/tests/support/trot.hpp"

namespace shapeid::bench {

/// From one cuboid around the base to `shapes` parts, on one second of a trot: problem k has k + 1
/// shapes. Criterion (16) picks them by the masses that Lawson-Hanson finds at lambda = 0, the
/// published problem.
[[nodiscard]] std::vector<DenseProblem> division_run(SeedSet seeds, std::uint64_t number,
                                                     test::Noise noise, Density density,
                                                     int shapes);

}  // namespace shapeid::bench
