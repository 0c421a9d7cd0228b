// Measured logs of MIT's Mini Cheetah (docs/data.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::experiments {

/// The folder of its logs under SHAPEID_DATA, else beside the source tree; nothing if there is
/// none.
[[nodiscard]] std::optional<std::string> cheetah_folder();

struct Cheetah {
  Robot robot;  ///< CAD inertias, feet
  std::string folder;
};
[[nodiscard]] Cheetah read_cheetah(const std::string& folder);

/// Samples of a log at 20 Hz cutoff, every `every`th of them, without those at impacts (specific
/// force of 25 m/s^2 and more). What the rotors take (CAD inertia through the gear) is taken off
/// the torques if `rotors`.
[[nodiscard]] std::vector<Sample> cheetah_samples(const Cheetah& cheetah, const std::string& log,
                                                  std::size_t every, bool rotors);

/// Those with a foot on the ground.
[[nodiscard]] std::vector<Sample> standing(const std::vector<Sample>& samples);

/// kg m^2 of joint j's rotor, seen through its gear.
[[nodiscard]] double reflected_inertia(int joint);

}  // namespace shapeid::experiments
