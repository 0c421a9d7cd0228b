// What a number of the answer comes from: the data, or shapes and bounds.
#pragma once

#include <Eigen/Core>

#include <string>

#include "shapeid/app/result.hpp"

namespace shapeid::app {

/// As `determined_by` of docs/formats/result.md has it, of the sought parameter at this place.
[[nodiscard]] std::string number_source(const reference::Identification& found, Eigen::Index at);

/// Whether the data say something else behind the slower filter than the errors of either allow.
[[nodiscard]] bool hangs_on_filter(const reference::Identification& found, Eigen::Index at);

/// number_source() for people to read; where the data say what no body has, with their value of
/// what is sought, and where they say something else behind the slower filter, with that. `known`:
/// what of the parameter is not sought.
[[nodiscard]] std::string number_source_text(const Result& result, Eigen::Index at, double known);

/// Adds a note if numbers hang on the filter.
void note_numbers_that_hang(Result& result);

/// What else the table's columns mean, a line each.
[[nodiscard]] std::string number_source_legend(const reference::Identification& found);

}  // namespace shapeid::app
