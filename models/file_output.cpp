#include "shapeid/models/file_output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "shapeid/models/error.hpp"

namespace shapeid {
namespace {

namespace fs = std::filesystem;

/// The path behind symbolic links; of a link to nowhere the path itself.
std::string behind_links(const std::string& path) {
  std::error_code none;
  const fs::path real = fs::canonical(path, none);
  return none ? path : real.string();
}

}  // namespace

OutputPlace::OutputPlace(std::string path) : path_(std::move(path)), final_(behind_links(path_)) {
  std::error_code ignored;
  const fs::file_status now = fs::status(path_, ignored);
  if (fs::is_directory(now)) {
    throw InputError({path_}, "is a folder", "name a file");
  }
  const bool replaceable = !fs::exists(now) || fs::is_regular_file(now);
  writable_ = replaceable ? fmt::format("{}.part{}", final_, ::getpid()) : path_;
}

void OutputPlace::finish() const {
  if (writable_ == path_) return;
  std::error_code failed;
  fs::rename(writable_, final_, failed);
  if (failed) fail("cannot be replaced: " + failed.message());
}

void OutputPlace::discard() const noexcept {
  std::error_code ignored;
  if (writable_ != path_) fs::remove(writable_, ignored);
}

void OutputPlace::fail(const std::string& wrong) const {
  discard();
  throw InputError({path_}, wrong, "name a writable file, where there is room for it");
}

void write_file(const std::string& path, const std::string& text) {
  const OutputPlace place(path);
  std::ofstream out(place.writable(), std::ios::binary);
  out << text;
  out.close();
  if (!out) place.fail("cannot be written");
  place.finish();
}

}  // namespace shapeid
