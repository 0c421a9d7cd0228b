#include "shapeid/models/file_output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "shapeid/models/error.hpp"

namespace shapeid {

void write_file(const std::string& path, const std::string& text) {
  const std::string beside = fmt::format("{}.part{}", path, ::getpid());
  {
    std::ofstream out(beside, std::ios::binary);
    out << text;
    out.close();
    if (!out) {
      std::error_code ignored;
      std::filesystem::remove(beside, ignored);
      throw InputError({path}, "cannot be written", "name a writable folder with room in it");
    }
  }
  std::error_code failed;
  std::filesystem::rename(beside, path, failed);
  if (failed) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw InputError({path}, "cannot be replaced: " + failed.message(), "name a writable file");
  }
}

}  // namespace shapeid
