// The folder that a verb leaves its files in.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shapeid::app {

struct OutputFile {
  std::string name, content;
};

/// A folder, made if it is not there. Throws InputError.
class OutputFolder {
 public:
  explicit OutputFolder(const std::string& folder);

  /// All that belong together at once, so that what cannot be made or written prevents them all:
  /// beside their places first, then renamed. Says on standard error what was written.
  void write(const std::vector<OutputFile>& files) const;

 private:
  std::filesystem::path folder_;
};

/// Before the work: throws InputError if the folder cannot be made, or nothing can be written into
/// it. Leaves nothing behind, so that what is refused later has made no folder.
void check_folder_writable(const std::string& folder);

}  // namespace shapeid::app
