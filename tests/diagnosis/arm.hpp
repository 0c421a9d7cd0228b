// An arm whose logs are computed: the truth is a model with effects, the torque its prediction.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "shapeid/diagnosis/checks.hpp"
#include "shapeid/diagnosis/loop.hpp"

namespace shapeid::test {

/// Three revolute joints on a fixed base, links of 1 to 3 kg with asymmetric inertias.
[[nodiscard]] Robot arm();

struct ArmLog {
  std::vector<diagnosis::AppliedEffect> effects;  ///< the truth, besides arm()'s inertias
  double seconds = 20.0;
  double noise = 0.02;  ///< N m, of the logged torque
  std::uint32_t seed = 1;
};

/// Sums of sines at 100 Hz with exact derivatives, tau logged with noise.
[[nodiscard]] diagnosis::Recording record(const ArmLog& log);
/// The same, with something in it that no effect of the catalogue is.
[[nodiscard]] diagnosis::Recording record(const ArmLog& log,
                                          const std::function<void(std::vector<Sample>&)>& change);

/// The arm's motion, with the torque of another robot on a fixed base with as many joints; exact.
[[nodiscard]] diagnosis::Recording moved_as_arm(
    const Robot& robot, const std::vector<diagnosis::AppliedEffect>& effects);

/// A log whose encoder of joint 2 sits on the motor, ahead of the joint by `lead` of the drive's
/// torque, in position, speed and acceleration.
[[nodiscard]] diagnosis::Recording before_a_gear(double (*lead)(double torque));

/// All links but the root sought, as `shapeid diagnose` would.
[[nodiscard]] diagnosis::LoopSettings arm_settings();

/// The loop on such a log, without a reference.
[[nodiscard]] diagnosis::LoopResult loop_of(const diagnosis::Recording& log);

/// An effect of the catalogue with numbers.
[[nodiscard]] diagnosis::AppliedEffect effect(const std::string& id, int site,
                                              std::vector<double> value);

[[nodiscard]] std::vector<std::string> found_ids(const diagnosis::LoopResult& result);

}  // namespace shapeid::test
