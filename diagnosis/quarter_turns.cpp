#include "shapeid/diagnosis/quarter_turns.hpp"

#include <optional>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/diagnosis/refit.hpp"

namespace shapeid::diagnosis {

void try_quarter_turns(LoopState& state) {
  if (state.robot.root != Root::fixed) return;
  constexpr double quarter = 1.5707963267948966;
  constexpr double far_better = 0.5;  // of the squared error: what all else that is wrong may cost
  const AppliedEffect upright = at_start(*find_effect("gravity_tilt"), 0);
  double least = far_better * state.tallied({}).given_error().sum();
  std::optional<AppliedEffect> best;
  for (const int axis : {0, 1}) {
    for (const double turn : {-quarter, quarter}) {
      AppliedEffect turned = upright;
      turned.value[axis] = turn;
      state.result.model.effects = {turned};
      const double error = state.tallied({}).given_error().sum();
      if (!(error < least)) continue;
      least = error;
      best = turned;
    }
  }
  if (best) {
    state.result.found.push_back(
        {*best, hypothesis_id(state.robot, *best), Eigen::VectorXd::Zero(best->value.size())});
  }
  state.collect_effects();
  if (best) refit(state);
}

}  // namespace shapeid::diagnosis
