// Effects that the diagnosis's catalogue does not have.
#pragma once

#include <functional>
#include <vector>

#include "shapeid/tests/blind/parts/ingredients.hpp"

namespace shapeid::blind {

[[nodiscard]] std::vector<Kind> foreign_kinds();

/// Each reading's flag of a foot becomes what `told` says: of whether it touches, s since this
/// began (at the log's first reading: longer than any step), s until it ends.
void change_flags(Ingredients& in, int site,
                  const std::function<bool(bool touches, double since, double until)>& told);

/// Signals at t become those at t - seconds (>= 0), by Lagrange's polynomial through six readings:
/// a straight line between two would smooth a trot's torque, which then fits lags of all drives
/// better than a delay. `zero` clears them, `add` adds a share of another instant's.
void delay(Readings& readings, double seconds,
           const std::function<void(Sample&, const Sample&, double)>& add,
           const std::function<void(Sample&)>& zero);

}  // namespace shapeid::blind
