// Consecutive windows of a trot: what the online identifier solves.
#pragma once

#include <string>
#include <vector>

#include "shapeid/tests/bench/problems/dense_problem.hpp"
#include "shapeid/tests/bench/problems/seeds.hpp"
#include "shapeid/tests/support/trot.hpp"

namespace shapeid::bench {

/// The bundled quadruped with its feet.
[[nodiscard]] const Robot& quadruped();

/// The base as eleven shapes or as 54 points, everything else known.
[[nodiscard]] BodyModel base_shapes();
[[nodiscard]] BodyModel base_points();

/// Phi of all links with a base that is not the file's: eleven random masses, some of them zero.
[[nodiscard]] Eigen::VectorXd some_truth(std::uint64_t seed);

/// Trots of ten-sample windows (20 ms) that follow each other, one sequence after the other. The
/// problems are the published ones: W = 1, lambda = 0.
[[nodiscard]] std::vector<DenseProblem> base_windows(const BodyModel& model, SeedSet seeds,
                                                     test::Noise noise, Density density,
                                                     int sequences, int windows);

inline constexpr std::size_t window_samples = 10;

}  // namespace shapeid::bench
