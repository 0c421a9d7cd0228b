#include "shapeid/models/file_output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <climits>
#include <filesystem>
#include <fstream>
#include <list>
#include <set>
#include <system_error>
#include <thread>
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

/// A folder that no other process of ours changes meanwhile. The folder itself is locked, so that
/// no file is left behind by it, also by a process that is killed. Where folders cannot be locked
/// (some network file systems), nothing is.
class LockedFolder {
 public:
  explicit LockedFolder(const std::string& folder)
      : file_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    // Files take their places within a moment: who holds the lock for longer is none of us, such as
    // flock(1) around this very command, and is not waited for without end.
    constexpr auto longest = std::chrono::seconds(10);
    constexpr auto between_tries = std::chrono::milliseconds(1);
    const auto start = std::chrono::steady_clock::now();
    while (file_ >= 0 && ::flock(file_, LOCK_EX | LOCK_NB) != 0) {
      const bool held = errno == EWOULDBLOCK || errno == EINTR;
      if (!held || std::chrono::steady_clock::now() - start > longest) return;
      std::this_thread::sleep_for(between_tries);
    }
  }
  ~LockedFolder() {
    if (file_ >= 0) ::close(file_);
  }
  LockedFolder(const LockedFolder&) = delete;
  LockedFolder& operator=(const LockedFolder&) = delete;

 private:
  int file_;
};

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

void OutputPlace::check_writable() const {
  // A device or a pipe may act on being opened.
  if (writable_ == path_) return;
  std::ofstream out(writable_, std::ios::binary);
  if (!out) fail("cannot be written");
  out.close();
  discard();
}

void OutputPlace::keep_private() const {
  struct stat before {};
  if (writable_ == path_ || ::stat(final_.c_str(), &before) != 0) return;
  const int file = ::open(writable_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (file < 0) return;  // which is said when it is opened to be written
  static_cast<void>(::fchmod(file, (before.st_mode & 0777U) | S_IWUSR));
  ::close(file);
}

std::string OutputPlace::folder() const {
  const fs::path parent = fs::path(final_).parent_path();
  return behind_links(parent.empty() ? "." : parent.string());
}

void OutputPlace::finish() const {
  if (writable_ == path_) return;
  std::error_code failed;
  // As far as the file system has them; that it has none is no reason to write nothing.
  const fs::file_status before = fs::status(final_, failed);
  if (fs::is_regular_file(before)) fs::permissions(writable_, before.permissions(), failed);
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
      place.keep_private();
      std::ofstream out(place.writable(), std::ios::binary);
      out << file.text;
      out.close();
      if (!out) place.fail("cannot be written");
    }
    // In one order for all, so that no two wait for each other.
    std::set<std::string> folders;
    for (const OutputPlace& place : places) folders.insert(place.folder());
    std::list<LockedFolder> locked;
    for (const std::string& folder : folders) locked.emplace_back(folder);
    for (const OutputPlace& place : places) place.finish();
  } catch (...) {
    for (const OutputPlace& place : places) place.discard();
    throw;
  }
}

}  // namespace shapeid
