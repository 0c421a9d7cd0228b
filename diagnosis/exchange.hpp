// What the data cannot tell from an applied transformation would do as well in its place.
#pragma once

#include <vector>

#include "shapeid/diagnosis/loop_state.hpp"
#include "shapeid/diagnosis/selection.hpp"

namespace shapeid::diagnosis {

/// Names, for every transformation that was found and is applied, the selection's hidden candidates
/// that contain it without it: beside masses and the others these say the same. (Its own columns
/// are in `fixed`, beside which they never stood against it.) None whose numbers in its place would
/// not be believed.
void note_exchangeable(const BlockFits& fits, const Term& fixed, const std::vector<Candidate>& list,
                       const Selection& selection, LoopState& state);

}  // namespace shapeid::diagnosis
