// The problems that a division run meets, recorded once, so that every solver gets the same ones.
#pragma once

#include <vector>

#include "shapeid/tests/bench/problems/dense_problem.hpp"
#include "shapeid/tests/bench/problems/seeds.hpp"
#include "shapeid/tests/support/trot.hpp"

namespace shapeid::bench {

/// Whose masses criterion (16) sees. At lambda = 0 many masses may be at the minimum, and a shape
/// that has mass in one solver's answer has none in another's.
enum class PickedBy { lawson_hanson, ours };

/// From one cuboid around the base to `shapes` parts, on one second of a trot: problem k has k + 1
/// shapes, which criterion (16) picks at lambda = 0, the published problem.
[[nodiscard]] std::vector<DenseProblem> division_run(SeedSet seeds, std::uint64_t number,
                                                     test::Noise noise, Density density,
                                                     PickedBy picked_by, int shapes);

}  // namespace shapeid::bench
