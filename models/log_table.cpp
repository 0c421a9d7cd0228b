#include "shapeid/models/log_table.hpp"

#include <csv.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "shapeid/models/number.hpp"

namespace shapeid {
namespace {

// A log of a thousand columns of 25 characters has lines of 25 kB; a file without line ends must
// not fill the memory.
constexpr std::size_t longest_line = 1 << 20;

double number(std::string_view text, const Place& place) {
  if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::optional<double> value = parse_number(text);
  if (!value) {
    throw InputError(place, why_no_number(text),
                     "write decimals with a point, and nothing for a missing value");
  }
  if (std::abs(*value) > largest_reading) {
    throw InputError(place, fmt::format("\"{}\" is more than any sensor reads", text),
                     "check the value and its unit");
  }
  return *value;
}

/// Of a header, where "nan" is no name either.
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

/// Splits lines into fields by libcsv, which knows quoting.
class LogTable::Splitter {
 public:
  Splitter() {
    if (csv_init(&parser_, CSV_STRICT | CSV_STRICT_FINI) != 0) throw std::bad_alloc();
  }
  ~Splitter() { csv_free(&parser_); }
  Splitter(const Splitter&) = delete;
  Splitter& operator=(const Splitter&) = delete;

  /// False if the quotes do not match.
  bool split(std::string line, std::vector<std::string>& fields) {
    row_.clear();
    complete_ = false;
    line.push_back('\n');
    const std::size_t used =
        csv_parse(&parser_, line.data(), line.size(), &Splitter::field, &Splitter::end, this);
    fields = row_;
    return used == line.size() && complete_;
  }

 private:
  static void field(void* text, std::size_t size, void* self) {
    static_cast<Splitter*>(self)->row_.emplace_back(static_cast<const char*>(text), size);
  }
  static void end(int, void* self) { static_cast<Splitter*>(self)->complete_ = true; }

  csv_parser parser_;
  std::vector<std::string> row_;
  bool complete_ = false;
};

void refuse_long(std::size_t size, const Place& place) {
  if (size <= longest_line) return;
  throw InputError(place, fmt::format("line longer than {} bytes", longest_line),
                   "a log has one row a line");
}

void refuse_carriage_returns(std::string_view part, const Place& place) {
  if (part.find('\r') == std::string_view::npos) return;
  throw InputError(place, "holds a carriage return inside a line", "end lines with LF or CRLF");
}

void clean_line(std::string& line, const Place& place) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (place.line == 1 && line.starts_with(byte_order_mark)) line.erase(0, byte_order_mark.size());
  if (line.ends_with('\r')) line.pop_back();
  if (line.find('\0') != std::string::npos) {
    throw InputError(place, "holds a NUL byte", "a log is text");
  }
  refuse_carriage_returns(line, place);
}

LogTable::LogTable(std::string path, const std::string& header, int line)
    : path_(std::move(path)), splitter_(std::make_unique<Splitter>()) {
  split(header, line);
  check_header(fields_, {path_, line});
  columns_ = fields_;
}
LogTable::~LogTable() = default;
LogTable::LogTable(LogTable&&) noexcept = default;
LogTable& LogTable::operator=(LogTable&&) noexcept = default;

void LogTable::split(const std::string& text, int line) {
  if (splitter_->split(text, fields_)) return;
  throw InputError({path_, line}, "quotes do not match", "close every quote on its own line");
}

LogRow LogTable::row(const std::string& text, int line) {
  split(text, line);
  if (fields_.size() != columns_.size()) {
    const bool is_comment = columns_.front().starts_with('#');
    throw InputError(
        {path_, line},
        fmt::format("has {} fields where the header has {}", fields_.size(), columns_.size()),
        is_comment ? "begin with a row of column names, not with a comment"
                   : "give one number a column, decimals with a point");
  }
  LogRow row{line, std::vector<double>(fields_.size())};
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    row.values[i] = number(fields_[i], {path_, line, columns_[i]});
  }
  return row;
}

}  // namespace shapeid
