// Numbers of what was found that no column is linear in.
#pragma once

#include "shapeid/diagnosis/loop_state.hpp"

namespace shapeid::diagnosis {

/// Shape numbers by zooming grids, transformations by Gauss-Newton, masses along with both.
void refit(LoopState& state);

/// The same, after the shape of found number `i` was sought far from where it is
/// (distant_variants()).
void refit_from_afar(LoopState& state, std::size_t i);

/// Masses and the numbers of all that was found, linearised where it stands.
void refit_numbers(LoopState& state);

}  // namespace shapeid::diagnosis
