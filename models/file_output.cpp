#include "shapeid/models/file_output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <climits>
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

/// Files that are being written, for a signal's handler: it may not allocate or wait.
constexpr std::size_t most_unfinished = 16;
struct Unfinished {
  std::atomic<bool> used = false;
  std::array<char, PATH_MAX> path{};
};
std::array<Unfinished, most_unfinished> unfinished;

/// Further files than there is room for are not removed by a signal.
void begin_file(const std::string& path) {
  if (path.size() >= PATH_MAX) return;
  for (Unfinished& slot : unfinished) {
    if (slot.path.front() != '\0' || slot.used) continue;
    std::copy_n(path.c_str(), path.size() + 1, slot.path.begin());
    slot.used = true;
    return;
  }
}

void end_file(const std::string& path) {
  for (Unfinished& slot : unfinished) {
    if (!slot.used || path != slot.path.data()) continue;
    slot.used = false;
    slot.path.front() = '\0';
    return;
  }
}

}  // namespace

void remove_unfinished_files() noexcept {
  for (const Unfinished& slot : unfinished) {
    if (slot.used) ::unlink(slot.path.data());
  }
}

OutputPlace::OutputPlace(std::string path) : path_(std::move(path)), final_(behind_links(path_)) {
  std::error_code ignored;
  const fs::file_status now = fs::status(path_, ignored);
  if (fs::is_directory(now)) {
    throw InputError({path_}, "is a folder", "name a file");
  }
  const bool replaceable = !fs::exists(now) || fs::is_regular_file(now);
  writable_ = replaceable ? fmt::format("{}.part{}", final_, ::getpid()) : path_;
  if (writable_ != path_) begin_file(writable_);
}

void OutputPlace::finish() const {
  if (writable_ == path_) return;
  std::error_code failed;
  fs::rename(writable_, final_, failed);
  end_file(writable_);
  if (failed) fail("cannot be replaced: " + failed.message());
}

void OutputPlace::discard() const noexcept {
  if (writable_ == path_) return;
  std::error_code ignored;
  fs::remove(writable_, ignored);
  end_file(writable_);
}

void OutputPlace::fail(const std::string& wrong) const {
  discard();
  throw InputError({path_}, wrong, "name a writable file, where there is room for it");
}

void write_file(const std::string& path, const std::string& text) { write_files({{path, text}}); }

void write_files(const std::vector<FileText>& files) {
  std::vector<OutputPlace> places;
  places.reserve(files.size());
  try {
    for (const FileText& file : files) {
      const OutputPlace& place = places.emplace_back(file.path);
      std::ofstream out(place.writable(), std::ios::binary);
      out << file.text;
      out.close();
      if (!out) place.fail("cannot be written");
    }
    for (const OutputPlace& place : places) place.finish();
  } catch (...) {
    for (const OutputPlace& place : places) place.discard();
    throw;
  }
}

}  // namespace shapeid
