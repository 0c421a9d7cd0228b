// Table I and Figures 4, 5, 8 and 9: the methods on one gait, many seeds, exact and as measured.
#pragma once

#include "shapeid/tests/experiments/data/motions.hpp"
#include "shapeid/tests/experiments/page/findings.hpp"

namespace shapeid::experiments {

/// Numbers "methods.GAIT.DATA.METHOD.WHAT", with ".lowest", ".median", ".highest" over the seeds;
/// DATA is exact or robot. What: errors "mass", "first", "tensor", "published" of the filtered
/// parameters and "raw" (published norm, unfiltered), f "before" and "after" filter (17), "next"
/// (f of the next window at the filtered parameters), "pieces", "gap" (largest proven distance to
/// the optimum of the method's own set, over || F ||^2), "unseen" (N m: residual torque on another
/// motion).
[[nodiscard]] Findings table_one(const Gait& gait, Form form);

}  // namespace shapeid::experiments
