// Where the bundled robot lies.
#pragma once

#include <string>

namespace shapeid::app {

/// Path of a file of models/robots: beside the installed command, else in the source tree it was
/// built from. Throws InputError if it is in neither.
[[nodiscard]] std::string bundled(const std::string& name);

}  // namespace shapeid::app
