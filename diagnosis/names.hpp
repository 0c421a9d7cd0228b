// Whether the names of what was found stand.
#pragma once

#include "shapeid/diagnosis/loop_state.hpp"

namespace shapeid::diagnosis {

/// Marks what was found by a name that does not stand, and sets the strangers: a name is worth more
/// than any law that no robot has, its number is constant, and laws without a name explain no more.
void question_names(LoopState& state);

/// Whether it is worth less than all that is unknown on the same joints, and may be a part of that:
/// laws without a name, and effects whose number follows a signal.
[[nodiscard]] bool is_beside_unknown(const Robot& robot, const LoopResult& loop, const Found& f);

}  // namespace shapeid::diagnosis
