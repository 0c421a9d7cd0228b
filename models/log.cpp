#include "shapeid/models/log.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>

#include "shapeid/models/error.hpp"

namespace shapeid {
namespace {

// Small enough that a live stream is not held back by more than a few dozen rows.
constexpr std::size_t block_size = 1 << 14;

/// Lines of a file, plain or gzipped, without their ends.
class LineSource {
 public:
  explicit LineSource(const std::string& path) : path_(path) {
    constexpr int standard_input = 0;
    file_ = path == "-" ? gzdopen(standard_input, "rb") : gzopen(path.c_str(), "rb");
    if (file_ == nullptr) throw InputError({path}, "cannot be opened", "give a readable CSV file");
  }
  ~LineSource() { gzclose_r(file_); }
  LineSource(const LineSource&) = delete;
  LineSource& operator=(const LineSource&) = delete;

  /// The next line into `line`; false at the end of the file.
  bool next(std::string& line) {
    line.clear();
    while (true) {
      const auto end = std::find(begin_, end_, '\n');
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
    const int got = gzread(file_, block_.data(), static_cast<unsigned>(block_.size()));
    int code = Z_OK;
    const char* text = gzerror(file_, &code);
    // A truncated gzip file still hands out what it has: only the code tells.
    if (got < 0 || (code != Z_OK && code != Z_STREAM_END)) {
      throw InputError({path_, number_ + 1}, fmt::format("cannot be read: {}", text),
                       "give a complete CSV or gzipped CSV file");
    }
    begin_ = block_.data();
    end_ = begin_ + got;
    return got > 0;
  }

  std::string path_;
  gzFile file_ = nullptr;
  std::array<char, block_size> block_;
  const char* begin_ = nullptr;
  const char* end_ = nullptr;
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
