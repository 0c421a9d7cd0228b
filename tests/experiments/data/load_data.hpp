// Data of an unknown load on the quadruped's base, and how well it is found.
#pragma once

#include <cstdint>
#include <vector>

#include "shapeid/tests/experiments/data/motions.hpp"
#include "shapeid/tests/experiments/data/windows.hpp"

namespace shapeid::experiments {

/// How a log becomes rows. The default is the best pair of docs/recovery.md.
struct Preparation {
  double noise = 1.0;     ///< times the sigmas of robot.yaml
  double signals = 80.0;  ///< Hz, cutoff of the filter over every channel
  double rows = 20.0;     ///< Hz, cutoff of the filter over the rows; 0: none
  std::uint64_t seed = 1;
};

/// Rows of all samples, contact forces projected out, as one window.
[[nodiscard]] DataTerm prepared(const test::Quadruped& quadruped, const BodyModel& model,
                                const std::vector<SimulatedSample>& motion, double seconds,
                                const Preparation& preparation);

/// The robot as its owner has it: the truth, or with the base that the eleven shapes gave on
/// another log, which had noise and no load.
[[nodiscard]] Robot with_identified_base(const test::Quadruped& quadruped, double seconds);

/// Where a load may be: a box on the base's top plate, 40 x 20 x 6 cm.
[[nodiscard]] BodyModel load_area(const Robot& robot);

struct LoadError {
  double mass = 0.0;    ///< kg
  double place = 0.0;   ///< m, centre of mass
  double tensor = 0.0;  ///< relative, about the load's own centre, Frobenius norm
};

[[nodiscard]] LoadError load_error(const Vector10& found, const InertialParameters& truth);

}  // namespace shapeid::experiments
