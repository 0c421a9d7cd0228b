// A fixed base that stands on its side.
#pragma once

#include "shapeid/diagnosis/loop_state.hpp"

namespace shapeid::diagnosis {

/// Before anything is sought: if the given links predict the logged torque far better with the
/// base turned by a quarter (a robot on a wall that is modelled upright), its numbers are refined,
/// and it is found if the same holds on held-out blocks with masses refitted. The derivative of a
/// tilt, by which others are found, does not always lead that far.
void try_quarter_turns(LoopState& state);

}  // namespace shapeid::diagnosis
