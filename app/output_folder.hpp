// The folder that a verb leaves its files in.
#pragma once

#include <filesystem>
#include <string>

namespace shapeid::app {

/// A folder, made if it is not there. Throws InputError.
class OutputFolder {
 public:
  explicit OutputFolder(const std::string& folder);

  /// Beside its place first, then renamed; says on standard error what was written.
  void write(const std::string& name, const std::string& content) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace shapeid::app
