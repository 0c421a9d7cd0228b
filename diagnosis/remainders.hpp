// Causes that are only what another one lacked as long as its shape was not right.
#pragma once

#include <optional>

#include "shapeid/diagnosis/loop_state.hpp"

namespace shapeid::diagnosis {

/// A law comes in with its usual shape (how wide the step of friction is) or with the one that
/// looks strongest (the period of a ripple). What that lacks another law of the same joint
/// explains, which from then on keeps the first from the shape that would need no other. So of
/// several at a joint the one that gains least is left out and the strongest of the others sought
/// from afar. If that predicts as well, and little is left that the first could gain, it stays out;
/// else the next is asked. Returns what was left out, if anything was. Gains are those of Found:
/// they, and what else is said of the others, hold no longer then.
std::optional<AppliedEffect> leave_out_remainder(LoopState& state);

}  // namespace shapeid::diagnosis
