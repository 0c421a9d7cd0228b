// What the loop keeps of rounds that do not settle.
#pragma once

#include <cstddef>
#include <vector>

#include "shapeid/diagnosis/loop_state.hpp"

namespace shapeid::diagnosis {

/// Leaves the state with that of the rounds (one at least) whose model leaves least on blocks that
/// are held out, all judged with the weights and the correction that the state has: the last
/// round's. The times remain. Returns which one.
std::size_t take_best_of(const std::vector<LoopResult>& rounds, LoopState& state);

}  // namespace shapeid::diagnosis
