// Whether the names of what was found stand.
#pragma once

#include "shapeid/diagnosis/loop_state.hpp"

namespace shapeid::diagnosis {

/// Marks what was found by a name that does not stand, and sets the strangers: a name is worth more
/// than any law that no robot has, its number is constant, and laws without a name explain no more.
void question_names(LoopState& state);

}  // namespace shapeid::diagnosis
