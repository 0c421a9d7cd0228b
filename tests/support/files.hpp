// Files that tests read: those of the project, those that they have written, logs of real robots.
#pragma once

#include <filesystem>
#include <string>

namespace shapeid::test {

/// The whole file, byte for byte. Throws std::runtime_error if it cannot be opened: a file that is
/// missing is not one that is empty.
[[nodiscard]] std::string text_of(const std::filesystem::path& path);

/// Where the data lie that are no part of the project: the folder that SHAPEID_DATA names, else
/// ../shared/data beside the repository. Need not exist.
[[nodiscard]] std::filesystem::path data_folder();

}  // namespace shapeid::test
