// Spreads in findings and in tables.
#pragma once

#include <string>
#include <vector>

#include "shapeid/tests/experiments/page/findings.hpp"

namespace shapeid::experiments {

/// Sets name.lowest, name.median and name.highest.
void set_spread(Findings& findings, const std::string& name, const std::vector<double>& numbers);

/// "median (lowest to highest)" of a name that set_spread() set.
[[nodiscard]] std::string with_spread(const Findings& findings, const std::string& name);

/// The median alone.
[[nodiscard]] std::string median(const Findings& findings, const std::string& name);

}  // namespace shapeid::experiments
