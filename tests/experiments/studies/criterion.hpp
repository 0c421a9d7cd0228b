// Criterion (16) at work: which shapes it divides, and where that stalls.
#pragma once

#include "shapeid/tests/experiments/page/findings.hpp"

namespace shapeid::experiments {

/// Numbers "criterion.DATA.CHOICE.*" of a 1 kg load, DATA exact or robot: "left" (f above the floor
/// of infinitely many divisions after all divisions, over what it was before the first), "useless"
/// (share of divisions that took less than a hundredth of what was left above the floor),
/// "smallest" (log10 of the smallest share of the area that was divided), "place_mm", "reached"
/// (divisions until a ten-thousandth is left; the number of all divisions plus one if never).
/// Medians over places.
[[nodiscard]] Findings criterion(Form form);

}  // namespace shapeid::experiments
