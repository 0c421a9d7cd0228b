#include "shapeid/models/log.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include "shapeid/models/error.hpp"

namespace shapeid {
namespace {

// Small enough that a live stream is not held back by more than a few dozen rows.
constexpr std::size_t block_size = 1 << 14;

/// Bytes of a file, plain or gzipped, in blocks. An archive may have several members, one behind
/// the other, and nothing else: what stands behind a member and is none is damage, where zlib's own
/// reader would see the end.
class ByteSource {
 public:
  explicit ByteSource(const std::string& path) {
    file_ = path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file_ < 0) throw InputError({path}, "cannot be opened", "give a readable CSV file");
  }
  ~ByteSource() {
    if (file_ != STDIN_FILENO) ::close(file_);
    if (zipped_ && *zipped_) inflateEnd(&stream_);
  }
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  /// The next bytes; none at the end. Empty, with the reason in `wrong`, if they cannot be had.
  std::string_view next(std::string& wrong) {
    if (!zipped_ && !look(wrong)) return {};
    if (*zipped_) return inflated(wrong);
    if (!read_more(wrong)) return {};
    return {raw_.data(), std::exchange(raw_size_, 0)};
  }

 private:
  /// One read behind what raw_ holds from its beginning.
  bool read_behind(std::string& wrong) {
    ssize_t got = 0;
    do {
      got = ::read(file_, raw_.data() + raw_size_, raw_.size() - raw_size_);
    } while (got < 0 && errno == EINTR);
    if (got < 0) {
      wrong = std::strerror(errno);
      return false;
    }
    at_end_ = got == 0;
    raw_size_ += static_cast<std::size_t>(got);
    stream_.next_in = reinterpret_cast<Bytef*>(raw_.data());
    stream_.avail_in = static_cast<unsigned>(raw_size_);
    return true;
  }

  /// Something into raw_, unless there is something left in it.
  bool read_more(std::string& wrong) { return raw_size_ > 0 || at_end_ || read_behind(wrong); }

  /// Whether it is an archive. A pipe may hand out its first byte alone.
  bool look(std::string& wrong) {
    constexpr std::string_view magic = "\x1F\x8B";
    while (raw_size_ < magic.size() && !at_end_) {
      if (!read_behind(wrong)) return false;
    }
    zipped_ = std::string_view(raw_.data(), raw_size_).starts_with(magic);
    constexpr int gzip_only = 15 + 16;
    if (*zipped_ && inflateInit2(&stream_, gzip_only) != Z_OK) throw std::bad_alloc();
    return true;
  }

  std::string_view inflated(std::string& wrong) {
    while (true) {
      if (!read_more(wrong)) return {};
      if (raw_size_ == 0) {
        if (in_member_) wrong = "unexpected end of file";
        return {};
      }
      if (!in_member_) inflateReset(&stream_);
      in_member_ = true;
      stream_.next_out = reinterpret_cast<Bytef*>(text_.data());
      stream_.avail_out = static_cast<unsigned>(text_.size());
      const int code = inflate(&stream_, Z_NO_FLUSH);
      raw_size_ = stream_.avail_in;
      if (code == Z_STREAM_END) {
        in_member_ = false;
      } else if (code != Z_OK && code != Z_BUF_ERROR) {
        wrong = stream_.msg == nullptr ? "no gzip archive" : stream_.msg;
        return {};
      }
      const std::size_t got = text_.size() - stream_.avail_out;
      if (got > 0) return {text_.data(), got};
    }
  }

  int file_ = -1;
  std::array<char, block_size> raw_{}, text_{};
  std::size_t raw_size_ = 0;  ///< bytes that are not used yet
  bool at_end_ = false;
  std::optional<bool> zipped_;
  bool in_member_ = false;
  z_stream stream_{};
};

/// Lines of a file, plain or gzipped, without their ends.
class LineSource {
 public:
  explicit LineSource(const std::string& path) : path_(path), bytes_(path) {}

  /// The next line into `line`; false at the end of the file.
  bool next(std::string& line) {
    line.clear();
    while (true) {
      const auto* const end = std::find(begin_, end_, '\n');
      line.append(begin_, end);
      refuse_long(line.size(), {path_, number_ + 1});
      if (end != end_) {
        begin_ = end + 1;
        break;
      }
      if (!fill()) {
        if (line.empty()) return false;
        break;
      }
    }
    ++number_;
    clean_line(line, {path_, number_});
    return true;
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  bool fill() {
    std::string wrong;
    block_ = bytes_.next(wrong);
    if (!wrong.empty()) {
      throw InputError({path_, number_ + 1}, "cannot be read: " + wrong,
                       "give a complete CSV or gzipped CSV file");
    }
    begin_ = block_.begin();
    end_ = block_.end();
    return !block_.empty();
  }

  std::string path_;
  ByteSource bytes_;
  std::string_view block_;
  std::string_view::iterator begin_ = nullptr, end_ = nullptr;
  int number_ = 0;
};

}  // namespace

struct LogReader::State {
  explicit State(const std::string& p) : path(p), lines(p) {}

  std::string path;
  LineSource lines;
  std::string line;
  std::optional<LogTable> table;

  /// The next line that is not blank; false at the end. Blank lines may only stand at the end:
  /// elsewhere they are rows that lost their numbers.
  bool next_line() {
    int blank = 0;
    while (lines.next(line)) {
      if (line.find_first_not_of(" \t") == std::string::npos) {
        if (blank == 0) blank = lines.number();
        continue;
      }
      if (blank != 0) throw InputError({path, blank}, "is blank", "remove it");
      return true;
    }
    return false;
  }
};

LogReader::LogReader(const std::string& path) : state_(std::make_unique<State>(path)) {
  State& s = *state_;
  if (!s.next_line()) throw InputError({path}, "is empty", "begin with a row of column names");
  s.table.emplace(path, s.line, s.lines.number());
}
LogReader::~LogReader() = default;
LogReader::LogReader(LogReader&&) noexcept = default;
LogReader& LogReader::operator=(LogReader&&) noexcept = default;

const std::string& LogReader::path() const { return state_->path; }
const std::vector<std::string>& LogReader::columns() const { return state_->table->columns(); }
const LogTable& LogReader::table() const { return *state_->table; }

std::optional<LogRow> LogReader::next() {
  State& s = *state_;
  if (!s.next_line()) return std::nullopt;
  return s.table->row(s.line, s.lines.number());
}

}  // namespace shapeid
