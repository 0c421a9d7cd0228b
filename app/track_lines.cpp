#include "shapeid/app/track_lines.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <thread>
#include <utility>

#include "shapeid/models/error.hpp"
#include "shapeid/models/log_table.hpp"

namespace shapeid::app {
namespace {

constexpr std::size_t block_size = 1 << 14;
// A window is 20 ms: more often nothing could be answered.
constexpr std::chrono::milliseconds between_looks{10};

}  // namespace

LineFollower::LineFollower(std::string path, const FollowOptions& options)
    : path_(std::move(path)), options_(options) {
  file_ = path_ == "-" ? STDIN_FILENO : ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (file_ < 0) throw InputError({path_}, "cannot be opened", "give a readable CSV file");
  struct stat opened {};
  is_stream_ = path_ == "-" || (::fstat(file_, &opened) == 0 && !S_ISREG(opened.st_mode) &&
                                !S_ISDIR(opened.st_mode));
}

LineFollower::~LineFollower() {
  if (file_ != STDIN_FILENO) ::close(file_);
}

std::optional<Line> LineFollower::next() {
  while (true) {
    const std::size_t end = block_.find('\n', in_block_);
    line_.append(block_, in_block_, end == std::string::npos ? end : end - in_block_);
    refuse_long(line_.size(), {path_, number_ + 1});
    if (end != std::string::npos) {
      in_block_ = end + 1;
      ++number_;
      clean_line(line_, {path_, number_});
      return Line{std::exchange(line_, {}), number_, byte_ - (block_.size() - in_block_)};
    }
    // The last byte may be that of CRLF. Of lines that end with CR alone none would ever come.
    const std::string_view line = line_;
    refuse_carriage_returns(line.substr(0, line.size() - std::min<std::size_t>(line.size(), 1)),
                            {path_, number_ + 1});
    in_block_ = block_.size();
    if (!fill()) return std::nullopt;
  }
}

/// More bytes into block_; false if none will come.
bool LineFollower::fill() {
  block_.resize(block_size);
  in_block_ = 0;
  if (is_stream() && options_.patience > 0.0 && keeps_silent()) {
    block_.clear();
    return false;
  }
  ssize_t got = 0;
  do {
    got = ::read(file_, block_.data(), block_size);
  } while (got < 0 && errno == EINTR);
  if (got < 0) {
    throw InputError({path_, number_ + 1}, fmt::format("cannot be read: {}", std::strerror(errno)),
                     "give a readable CSV file");
  }
  block_.resize(static_cast<std::size_t>(got));
  if (byte_ == 0 && block_.starts_with("\x1f\x8b")) {
    throw InputError({path_}, "is compressed, and a file that grows cannot be",
                     "unpack it on the way: zcat LOG | shapeid track ... -");
  }
  byte_ += block_.size();
  return got > 0 || wait_for_more();
}

/// At the end of a file: true when it has grown, false when it is not to be waited for.
bool LineFollower::wait_for_more() {
  if (!options_.follow || is_stream()) return false;
  const auto start = std::chrono::steady_clock::now();
  while (true) {
    refuse_shrunk();
    struct stat now {};
    if (::fstat(file_, &now) == 0 && std::cmp_greater(now.st_size, byte_)) {
      return true;  // block_ is empty: the caller comes back for the bytes
    }
    refuse_replaced();
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start;
    if (options_.patience > 0.0 && waited.count() > options_.patience) return false;
    std::this_thread::sleep_for(between_looks);
  }
}

/// Whether a stream neither has more nor ends for as long as we wait.
bool LineFollower::keeps_silent() const {
  constexpr double most = std::numeric_limits<int>::max();
  const int milliseconds = static_cast<int>(std::min(std::ceil(1e3 * options_.patience), most));
  pollfd waiting{file_, POLLIN, 0};
  int ready = 0;
  do {
    ready = ::poll(&waiting, 1, milliseconds);
  } while (ready < 0 && errno == EINTR);
  return ready == 0;
}

void LineFollower::refuse_shrunk() const {
  struct stat now {};
  if (::fstat(file_, &now) != 0 || !std::cmp_less(now.st_size, byte_)) return;
  throw InputError({path_, number_},
                   fmt::format("has {} bytes, and {} were read from it", now.st_size, byte_),
                   "give a log that only grows");
}

/// Whoever goes on with the log writes into another file, for which nobody would wait.
void LineFollower::refuse_replaced() const {
  struct stat ours {};
  struct stat named {};
  if (::fstat(file_, &ours) != 0) return;
  const char* wrong = nullptr;
  if (::stat(path_.c_str(), &named) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) wrong = "is not there any more";
  } else if (named.st_dev != ours.st_dev || named.st_ino != ours.st_ino) {
    wrong = "is another file now";
  }
  if (wrong == nullptr) return;
  throw InputError({path_, number_},
                   fmt::format("{}; the one that was followed ends after {} bytes", wrong, byte_),
                   "follow a log that stays where it is");
}

void LineFollower::skip_to(int number, std::uint64_t begin, std::uint64_t end) {
  const off_t size = ::lseek(file_, 0, SEEK_END);
  if (size < 0 || std::cmp_less(size, end)) {
    throw InputError({path_}, fmt::format("has {} bytes, and the checkpoint read {}", size, end),
                     "resume with the same log");
  }
  ::lseek(file_, static_cast<off_t>(begin), SEEK_SET);
  block_.clear();
  line_.clear();
  in_block_ = 0;
  byte_ = begin;
  number_ = number - 1;
}

}  // namespace shapeid::app
