// The small form of every experiment, and what it gave when it was recorded.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace shapeid::experiments {

/// Every number of every experiment's small form, without spreads and what a clock said.
[[nodiscard]] std::map<std::string, double> small_values();

/// Numbers that are missing, new, or farther from those recorded than `relative` of their size; one
/// line each. What is nothing beside `smallest` counts as zero.
[[nodiscard]] std::vector<std::string> differences(const std::map<std::string, double>& recorded,
                                                   const std::map<std::string, double>& now,
                                                   double relative, double smallest);

}  // namespace shapeid::experiments
