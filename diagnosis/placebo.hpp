// What a wrong law is worth in this log: laws that no robot has, fitted like all others.
#pragma once

#include <string>
#include <vector>

#include "shapeid/diagnosis/fits.hpp"
#include "shapeid/diagnosis/series.hpp"

namespace shapeid::diagnosis {

/// Spring, viscous and dry friction and rotor as the catalogue has them, but fed with the motion of
/// another joint: position, velocity, direction and acceleration of joint k in the row of joint j.
/// Every joint gets those of two others, the next one and one half of the robot away. Empty for a
/// robot of one joint.
[[nodiscard]] std::vector<AppliedEffect> placebos(const Robot& robot);

/// The squared held-out error that the best of them takes away by more than chance, 0 if none does.
/// `terms` are the masses and all effects that were accepted; the tally has the placebos from
/// hypothesis `first` on, up to `last`.
[[nodiscard]] double best_placebo(const BlockFits& fits, const std::vector<Term>& terms,
                                  std::size_t first, std::size_t last);

/// Ripples of one joint's torque over the position of another, one for each other joint, with the
/// period that explains most of `left`: sought as the period of a ripple is (candidates.hpp).
[[nodiscard]] std::vector<AppliedEffect> ripple_placebos(const Robot& robot, const Recording& log,
                                                         const Series& left, int joint);

/// The joint in whose row a placebo is.
[[nodiscard]] int joint_of_placebo(const Robot& robot, const AppliedEffect& placebo);

}  // namespace shapeid::diagnosis
