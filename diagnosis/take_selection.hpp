// What a selection accepted becomes what the loop has found.
#pragma once

#include <vector>

#include "shapeid/diagnosis/loop_state.hpp"
#include "shapeid/diagnosis/selection.hpp"

namespace shapeid::diagnosis {

/// `fixed`: masses and applied transformations, which stay as they were judged and move by what
/// their columns were fitted with. All others that were found before are replaced.
void take_selection(const BlockFits& fits, const Term& fixed, const std::vector<Candidate>& list,
                    const Selection& selection, LoopState& state);

/// Of the first step: what was accepted, and what else was promising.
void note_first_ranking(const std::vector<Candidate>& list, const Selection& selection,
                        LoopResult& result);

}  // namespace shapeid::diagnosis
