#include "shapeid/models/log.hpp"

#include <csv.h>
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include "shapeid/models/error.hpp"

namespace shapeid {
namespace {

// A log of a thousand columns of 25 characters has lines of 25 kB; a file without line ends must
// not fill the memory.
constexpr std::size_t longest_line = 1 << 20;
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
      if (line.size() > longest_line) {
        throw InputError({path_, number_ + 1},
                         fmt::format("line longer than {} bytes", longest_line),
                         "a log has one row a line");
      }
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
    clean(line);
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

  void clean(std::string& line) const {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (number_ == 1 && line.starts_with(byte_order_mark)) line.erase(0, byte_order_mark.size());
    if (line.ends_with('\r')) line.pop_back();
    const Place here{path_, number_};
    if (line.find('\0') != std::string::npos) {
      throw InputError(here, "holds a NUL byte", "a log is text");
    }
    if (line.find('\r') != std::string::npos) {
      throw InputError(here, "holds a carriage return inside a line", "end lines with LF or CRLF");
    }
  }

  std::string path_;
  gzFile file_ = nullptr;
  std::array<char, block_size> block_;
  const char* begin_ = nullptr;
  const char* end_ = nullptr;
  int number_ = 0;
};

/// Splits lines into fields by libcsv, which knows quoting.
class FieldSplitter {
 public:
  FieldSplitter() {
    if (csv_init(&parser_, CSV_STRICT | CSV_STRICT_FINI) != 0) throw std::bad_alloc();
  }
  ~FieldSplitter() { csv_free(&parser_); }
  FieldSplitter(const FieldSplitter&) = delete;
  FieldSplitter& operator=(const FieldSplitter&) = delete;

  /// False if the quotes do not match.
  bool split(std::string line, std::vector<std::string>& fields) {
    row_.clear();
    complete_ = false;
    line.push_back('\n');
    const std::size_t used = csv_parse(&parser_, line.data(), line.size(), &FieldSplitter::field,
                                       &FieldSplitter::end, this);
    fields = row_;
    return used == line.size() && complete_;
  }

 private:
  static void field(void* text, std::size_t size, void* self) {
    static_cast<FieldSplitter*>(self)->row_.emplace_back(static_cast<const char*>(text), size);
  }
  static void end(int, void* self) { static_cast<FieldSplitter*>(self)->complete_ = true; }

  csv_parser parser_;
  std::vector<std::string> row_;
  bool complete_ = false;
};

double number(std::string_view text, const Place& place) {
  if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::string_view digits = text;
  const bool signed_twice = digits.size() > 1 && (digits[1] == '+' || digits[1] == '-');
  if (digits.front() == '+' && !signed_twice) digits.remove_prefix(1);  // from_chars knows only -
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    throw InputError(place, fmt::format("\"{}\" does not fit a double", text), "check the value");
  }
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
    throw InputError(place, fmt::format("\"{}\" is not a number", text),
                     "write decimals with a point, and nothing for a missing value");
  }
  return value;
}

bool is_number(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  return !text.empty() && std::from_chars(text.data(), end, value).ptr == end;
}

void check_header(const std::vector<std::string>& columns, const Place& place) {
  if (columns.size() == 1 && columns.front().find_first_of(";\t") != std::string::npos) {
    throw InputError(place, "fields are not separated by commas", "separate fields by commas");
  }
  if (std::all_of(columns.begin(), columns.end(), is_number)) {
    throw InputError(place, "the first row holds numbers", "begin with a row of column names");
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].empty()) {
      throw InputError({place.file, place.line, std::to_string(i + 1)}, "has no name",
                       "name every column");
    }
    if (!seen.insert(columns[i]).second) {
      throw InputError({place.file, place.line, columns[i]}, "appears twice",
                       "give every column its own name");
    }
  }
}

}  // namespace

struct LogReader::State {
  explicit State(const std::string& p) : path(p), lines(p) {}

  std::string path;
  LineSource lines;
  FieldSplitter splitter;
  std::vector<std::string> columns;
  std::string line;
  std::vector<std::string> fields;

  /// Fields of the next line that is not blank; false at the end. Blank lines may only stand at
  /// the end: elsewhere they are rows that lost their numbers.
  bool next_fields() {
    int blank = 0;
    while (lines.next(line)) {
      if (line.find_first_not_of(" \t") == std::string::npos) {
        if (blank == 0) blank = lines.number();
        continue;
      }
      if (blank != 0) throw InputError({path, blank}, "is blank", "remove it");
      if (!splitter.split(line, fields)) {
        throw InputError({path, lines.number()}, "quotes do not match",
                         "close every quote on its own line");
      }
      return true;
    }
    return false;
  }
};

LogReader::LogReader(const std::string& path) : state_(std::make_unique<State>(path)) {
  if (!state_->next_fields()) {
    throw InputError({path}, "is empty", "begin with a row of column names");
  }
  check_header(state_->fields, {path, state_->lines.number()});
  state_->columns = state_->fields;
}
LogReader::~LogReader() = default;
LogReader::LogReader(LogReader&&) noexcept = default;
LogReader& LogReader::operator=(LogReader&&) noexcept = default;

const std::string& LogReader::path() const { return state_->path; }
const std::vector<std::string>& LogReader::columns() const { return state_->columns; }

std::optional<LogRow> LogReader::next() {
  State& s = *state_;
  if (!s.next_fields()) return std::nullopt;
  const int line = s.lines.number();
  if (s.fields.size() != s.columns.size()) {
    throw InputError(
        {s.path, line},
        fmt::format("has {} fields where the header has {}", s.fields.size(), s.columns.size()),
        "give one number a column, decimals with a point");
  }
  LogRow row{line, std::vector<double>(s.fields.size())};
  for (std::size_t i = 0; i < s.fields.size(); ++i) {
    row.values[i] = number(s.fields[i], {s.path, line, s.columns[i]});
  }
  return row;
}

}  // namespace shapeid
