#include "shapeid/diagnosis/quarter_turns.hpp"

#include <optional>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/diagnosis/refit.hpp"

namespace shapeid::diagnosis {
namespace {

/// The turn with which the given model predicts best, if that is far better than upright.
std::optional<AppliedEffect> best_turn(LoopState& state) {
  double least = far_better * state.tallied({}).given_error().sum();
  std::optional<AppliedEffect> best;
  for (const AppliedEffect& turn : bases_on_their_side()) {
    state.result.model.effects = {turn};
    const double error = state.tallied({}).given_error().sum();
    if (!(error < least)) continue;
    least = error;
    best = turn;
  }
  state.collect_effects();
  return best;
}

}  // namespace

std::vector<AppliedEffect> bases_on_their_side() {
  std::vector<AppliedEffect> turns;
  for (const int axis : {0, 1}) {
    for (const double angle : {-quarter_turn, quarter_turn}) {
      turns.push_back(at_start(*find_effect("gravity_tilt"), 0));
      turns.back().value[axis] = angle;
    }
  }
  return turns;
}

void try_quarter_turns(LoopState& state) {
  if (state.robot.root != Root::fixed) return;
  const std::optional<AppliedEffect> turn = best_turn(state);
  if (!turn) return;
  const double upright = state.tallied({}).held_out({state.masses}).sum();
  state.result.found.push_back(
      {*turn, hypothesis_id(state.robot, *turn), Eigen::VectorXd::Zero(turn->value.size())});
  state.collect_effects();
  refit(state);
  // Of links that are given far too heavy less pulls where weight is along the joints' axes: then
  // masses say as much.
  if (state.held_out_of_model().sum() < far_better * upright) return;
  state.result.found.clear();
  state.collect_effects();
}

}  // namespace shapeid::diagnosis
