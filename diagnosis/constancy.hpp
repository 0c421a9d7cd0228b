// Is what was accepted what its name says? The number of an effect is a constant.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/diagnosis/fits.hpp"

namespace shapeid::diagnosis {

/// A law of which less than a twentieth is missing is still the best short name. In blind trials
/// true names were short of a fiftieth at most, wrong ones of a twentieth to all.
inline constexpr double material_share = 0.05;

/// How the number of an effect changes where it should not.
struct Variation {
  Signal signal = Signal::time;
  int joint = 0;       ///< whose signal it is; -1: of time, and the effect is of no joint
  double share = 0.0;  ///< further held-out gain by letting it, over the effect's own gain
  double z = 0.0;      ///< over its standard error
};

/// "q.knee", "dq.knee", "tau.knee", "time": the signal as a column of a log.
[[nodiscard]] std::string variable_of(const Variation& variation, const Robot& robot);

/// The joint whose motion an effect's number could follow: its own, or the one that moves its link
/// or contact. None for effects of the base, its accelerometer or the whole robot.
[[nodiscard]] std::optional<int> joint_of(const Robot& robot, const AppliedEffect& effect);

/// The joints whose torque an effect changes: its own; of links, lengths and encoders those between
/// the base and the link, and those behind a joint that is not where it seems; all, for an effect
/// of the whole robot or its base.
[[nodiscard]] std::vector<bool> reach_of(const Robot& robot, const AppliedEffect& effect);

/// What the number of an effect at a joint must not follow: position, speed and direction of the
/// joint, its predicted load and the load's side, the way since it turned round.
inline constexpr std::array joint_signals = {Signal::position, Signal::speed, Signal::direction,
                                             Signal::load,     Signal::side,  Signal::turned};

/// Signals that the numbers of effects must not follow: those of the joint where they sit, time,
/// and for an effect of the whole robot the joint.
[[nodiscard]] std::vector<Modulation> modulations(const Robot& robot,
                                                  const std::vector<AppliedEffect>& effects);

/// One entry an effect, the first `own_gain.size()` hypotheses of the tally: the variation that is
/// worth most, or none. `terms` are the masses and all effects' own; `own_gain` the held-out
/// squared error that each effect takes away. A variation counts if chance makes any of all that
/// are tried so significant in no more than one log of a hundred, and if held-out blocks gain by it
/// what a name cannot be short of (constancy.cpp).
[[nodiscard]] std::vector<std::optional<Variation>> variations(const BlockFits& fits,
                                                               const std::vector<Term>& terms,
                                                               const Eigen::VectorXd& own_gain);

}  // namespace shapeid::diagnosis
