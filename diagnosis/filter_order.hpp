// Filters of the load are sought to first order in their time constants; those found are then taken
// for what they are (docs/derivations/diagnosis-rows.md, a lag of one drive).
#pragma once

#include <vector>

#include "shapeid/diagnosis/loop_state.hpp"

namespace shapeid::diagnosis {

/// Of what was found the filters of the load.
[[nodiscard]] std::vector<Found> filters_among(const std::vector<Found>& found);

/// From now on filters are no longer to first order. Gains of their joints are taken out: the
/// second order looks like one, and what is applied is kept for less than what it takes to come in.
void take_filters_as_they_are(LoopState& state);

/// What a filter could not be told from to first order is named with it, but for what was found.
/// Beside a law that is right to higher order, others are asked by their derivatives alone.
void add_names_to_first_order(const std::vector<Found>& filters, std::vector<Found>& found);

}  // namespace shapeid::diagnosis
