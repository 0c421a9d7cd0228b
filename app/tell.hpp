// What is said beside the answer.
#pragma once

#include <string>

namespace shapeid::app {

/// Writes the text to standard error. Where that is closed, or full, nobody would read it: it is
/// lost, and the command goes on to its status.
void tell(const std::string& text) noexcept;

}  // namespace shapeid::app
