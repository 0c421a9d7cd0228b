// Files appear whole or not at all.
#pragma once

#include <string>

namespace shapeid {

/// Writes `text` beside `path` and renames it into place, so that a half-written file never
/// replaces a good one. Throws InputError if the place cannot be written (missing folder, full
/// disk).
void write_file(const std::string& path, const std::string& text);

}  // namespace shapeid
