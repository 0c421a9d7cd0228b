// A transformation that may be what several accepted candidates are: a delay of all joints is a
// drag and lags of single drives.
#pragma once

#include <optional>
#include <vector>

#include "shapeid/diagnosis/selection.hpp"

namespace shapeid::diagnosis {

/// Of the transformations in `list` that were not accepted the one that, as its derivative, takes
/// away most, and much, of what all that was accepted does: alone, or, if none does so, beside the
/// strongest of these. Empty if there is none, or fewer than two were accepted. `fixed`: what is
/// fitted along always.
[[nodiscard]] std::optional<Candidate> large_transformation(const BlockFits& fits,
                                                            const Term& fixed,
                                                            const std::vector<Candidate>& list,
                                                            const Selection& selection);

}  // namespace shapeid::diagnosis
