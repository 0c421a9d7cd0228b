// Is what was accepted what its name says? The number of an effect is a constant.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shapeid/diagnosis/fits.hpp"

namespace shapeid::diagnosis {

/// How the number of an effect changes where it should not.
struct Variation {
  Signal signal = Signal::time;
  int joint = 0;       ///< whose signal it is
  double share = 0.0;  ///< further held-out gain by letting it, over the effect's own gain
  double z = 0.0;      ///< over its standard error
};

/// "q.knee", "dq.knee", "tau.knee", "time": the signal as a column of a log.
[[nodiscard]] std::string variable_of(const Variation& variation, const Robot& robot);

/// The joint whose motion an effect's number could follow: its own, or the one that moves its link
/// or contact. None for effects of the base, its accelerometer or the whole robot.
[[nodiscard]] std::optional<int> joint_of(const Robot& robot, const AppliedEffect& effect);

/// Signals that the number of an effect must not follow: position, speed, direction and predicted
/// load of the joint where it sits, time, and for an effect of the whole robot the joint.
[[nodiscard]] std::vector<Modulation> modulations(const Robot& robot,
                                                  const std::vector<AppliedEffect>& effects);

/// One entry an effect, in the order of the tally's hypotheses: the variation that is worth most,
/// or none. `terms` are the masses and all effects' own; `own_gain` the held-out squared error that
/// each effect takes away. A variation counts if chance makes any of all that are tried so
/// significant in no more than one log of a hundred, and if held-out blocks gain by it what a name
/// cannot be short of (constancy.cpp).
[[nodiscard]] std::vector<std::optional<Variation>> variations(const BlockFits& fits,
                                                               const std::vector<Term>& terms,
                                                               const Eigen::VectorXd& own_gain);

}  // namespace shapeid::diagnosis
