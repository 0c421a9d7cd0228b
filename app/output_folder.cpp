#include "shapeid/app/output_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <system_error>

#include "shapeid/app/tell.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/file_output.hpp"

namespace shapeid::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* another_folder = "another folder";

/// What is there of the folder's path, at the least the folder where we are.
fs::path existing_part(const fs::path& folder) {
  fs::path part = folder;
  std::error_code unknown;
  while (!part.empty() && !fs::exists(fs::symlink_status(part, unknown))) {
    const fs::path parent = part.parent_path();
    if (parent == part) break;
    part = parent;
  }
  return part.empty() ? fs::path(".") : part;
}

}  // namespace

void check_folder_writable(const std::string& folder) {
  std::error_code failed;
  const fs::file_status now = fs::status(folder, failed);
  if (fs::is_directory(now)) {
    // Under a name that nobody gave, which is not said.
    const OutputPlace probe((fs::path(folder) / fmt::format("probe.{}", ::getpid())).string());
    try {
      probe.check_writable();
    } catch (const InputError&) {
      throw InputError({folder}, "no file can be written into this folder", another_folder);
    }
    return;
  }
  // A name that is too long, links in a circle: asking for more would say the same.
  if (failed && now.type() != fs::file_type::not_found) {
    throw InputError({folder}, "cannot be made: " + failed.message(), another_folder);
  }
  const fs::path there = existing_part(folder);
  if (!fs::is_directory(there, failed)) {
    const bool itself = there == fs::path(folder);
    throw InputError({there.string()}, "is no folder",
                     itself ? another_folder : fmt::format("{} for {}", another_folder, folder));
  }
  // Under a name of its own: another process may just be making the same folder.
  const fs::path probe = there / fmt::format("probe.part{}", ::getpid());
  failed.clear();
  fs::create_directory(probe, failed);
  if (failed) throw InputError({folder}, "cannot be made: " + failed.message(), another_folder);
  fs::remove(probe, failed);
}

OutputFolder::OutputFolder(const std::string& folder) : folder_(folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder_, failed);
  if (failed) throw InputError({folder}, "cannot be made: " + failed.message(), another_folder);
}

void OutputFolder::write(const std::vector<OutputFile>& files) const {
  std::vector<FileText> texts;
  texts.reserve(files.size());
  for (const OutputFile& file : files) {
    texts.push_back({(folder_ / file.name).string(), file.content});
  }
  write_files(texts);
  for (const FileText& text : texts) tell(fmt::format("wrote {}\n", text.path));
}

}  // namespace shapeid::app
