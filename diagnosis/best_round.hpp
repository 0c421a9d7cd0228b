// What the loop keeps of rounds that do not settle.
#pragma once

#include <vector>

#include "shapeid/diagnosis/loop_state.hpp"

namespace shapeid::diagnosis {

/// Leaves the state with that of the rounds (one at least) whose model leaves least on blocks that
/// are held out, all judged with the weights and the correction that the state has: the last
/// round's. The times remain.
void take_best_of(const std::vector<LoopResult>& rounds, LoopState& state);

}  // namespace shapeid::diagnosis
