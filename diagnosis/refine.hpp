// The outer search for the numbers that columns do not depend on linearly: grids that zoom in.
#pragma once

#include <cstddef>
#include <vector>

#include "shapeid/diagnosis/fits.hpp"

namespace shapeid::diagnosis {

/// The effect with its shape numbers on a grid: over their whole range in pass 0, ever closer about
/// the present ones after that. The first variant is the present one. `block`: the length of the
/// log's blocks, s.
[[nodiscard]] std::vector<AppliedEffect> shape_variants(const AppliedEffect& effect, int pass,
                                                        double block);

/// The effect with a number that is usually sought nearby (a ripple's period) anywhere from half to
/// twice of what it is; the first variant is the present one, and the only one of other effects.
[[nodiscard]] std::vector<AppliedEffect> distant_variants(const AppliedEffect& effect);

/// One variant for each effect so that the held-out error of all together is least, by going
/// through the effects in turn until nothing changes.
[[nodiscard]] std::vector<std::size_t> best_variants(const BlockFits& fits, const Term& masses,
                                                     const std::vector<std::vector<Term>>& choices);

}  // namespace shapeid::diagnosis
