// A log's lines as a table: the header, then one row of numbers after the other, wherever the lines
// come from.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "shapeid/models/error.hpp"

namespace shapeid {

/// No sensor reads more in any unit, and what is computed from readings stays far inside double.
inline constexpr double largest_reading = 1e100;

/// A row of numbers in the order of the columns. NaN marks an empty field.
struct LogRow {
  int line = 0;  ///< in the file, from 1
  std::vector<double> values;
};

/// Throws InputError for a line that is longer than any row of a log.
void refuse_long(std::size_t size, const Place& place);

/// Throws InputError for a carriage return in a part of a line.
void refuse_carriage_returns(std::string_view part, const Place& place);

/// Takes a byte order mark (of line 1) and the CR of CRLF away. Throws InputError for control
/// characters that no text has.
void clean_line(std::string& line, const Place& place);

/// Names of columns, and what turns a line into numbers. Throws InputError with file, line and
/// column for anything that is not a header followed by rows of as many numbers.
class LogTable {
 public:
  /// `header`: the line of column names, number `line` of the file.
  LogTable(std::string path, const std::string& header, int line);
  ~LogTable();
  LogTable(LogTable&&) noexcept;
  LogTable& operator=(LogTable&&) noexcept;
  LogTable(const LogTable&) = delete;
  LogTable& operator=(const LogTable&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  /// The row that a line holds.
  [[nodiscard]] LogRow row(const std::string& text, int line);

 private:
  class Splitter;
  void split(const std::string& text, int line);

  std::string path_;
  std::unique_ptr<Splitter> splitter_;
  std::vector<std::string> columns_, fields_;
};

}  // namespace shapeid
