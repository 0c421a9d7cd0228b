// What moves the answer about an unknown load: options of the division, length of the window,
// noise, filters, contact labels, the density term.
#pragma once

#include "shapeid/tests/experiments/page/findings.hpp"

namespace shapeid::experiments {

/// Numbers "load.influence.GROUP.VALUE.{divisions,mass,place_mm,tensor}.*" over the seeds, at the
/// stop of the step rule. One thing is changed at a time, from the defaults.
[[nodiscard]] Findings load_influence(Form form);

}  // namespace shapeid::experiments
