// A fixed base that stands on its side.
#pragma once

#include <numbers>
#include <vector>

#include "shapeid/diagnosis/loop_state.hpp"

namespace shapeid::diagnosis {

inline constexpr double quarter_turn = 0.5 * std::numbers::pi;
/// Of the squared error that the given links leave: what is less with another turn is no chance.
inline constexpr double far_better = 0.5;

/// A base turned by a quarter about x or y, either way.
[[nodiscard]] std::vector<AppliedEffect> bases_on_their_side();

/// Before anything is sought: if the given links predict the logged torque far better with the
/// base turned by a quarter (a robot on a wall that is modelled upright), its numbers are refined,
/// and it is found if the same holds on held-out blocks with masses refitted. The derivative of a
/// tilt, by which others are found, does not always lead that far.
void try_quarter_turns(LoopState& state);

}  // namespace shapeid::diagnosis
