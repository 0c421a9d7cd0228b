// Motions of a trotting quadruped that satisfy its equation of motion exactly, or but for sensor
// noise. Kinematic, so that thousands of them cost nothing and one number (the seed) is the input.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::test {

enum class Noise {
  none,    ///< consistent to rounding
  sensors  ///< of a usual MEMS IMU, encoders behind a gear, torques from motor currents
};

/// `count` samples at 500 Hz. Joints and base follow sums of sines; two diagonal feet stand at a
/// time. Two point contacts cannot exert a moment about the line between them, so the base's
/// acceleration is corrected, by as little as possible, until none is needed; then the forces of
/// the feet and the torques follow from Phi (10 per link, stacked). Noise comes after that.
[[nodiscard]] std::vector<Sample> trot(const Robot& robot, const Eigen::VectorXd& Phi,
                                       std::uint64_t seed, std::size_t count, Noise noise);

}  // namespace shapeid::test
