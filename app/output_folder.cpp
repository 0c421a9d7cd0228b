#include "shapeid/app/output_folder.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <system_error>

#include "shapeid/app/tell.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/file_output.hpp"

namespace shapeid::app {

OutputFolder::OutputFolder(const std::string& folder) : folder_(folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder_, failed);
  if (failed) throw InputError({folder}, "cannot be made: " + failed.message(), "another folder");
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
