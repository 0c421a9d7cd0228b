// Logs as tables: CSV or CSV.gz, read row by row in fixed memory.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/log_table.hpp"

namespace shapeid {

/// Reads a CSV or gzipped CSV file one row at a time, whatever its size. Throws InputError with
/// file, line and column for anything that is not a header followed by rows of as many numbers.
class LogReader {
 public:
  explicit LogReader(const std::string& path);
  ~LogReader();
  LogReader(LogReader&&) noexcept;
  LogReader& operator=(LogReader&&) noexcept;
  LogReader(const LogReader&) = delete;
  LogReader& operator=(const LogReader&) = delete;

  [[nodiscard]] const std::string& path() const;
  [[nodiscard]] const std::vector<std::string>& columns() const;
  [[nodiscard]] const LogTable& table() const;
  /// The next row; empty at the end of the file.
  [[nodiscard]] std::optional<LogRow> next();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// mapping.yaml: how a foreign log's columns become ours.
struct ColumnRule {
  std::string from;    ///< column of the foreign log
  double scale = 1.0;  ///< ours = sign * scale * theirs + offset
  double offset = 0.0;
  double sign = 1.0;
  std::string hold;  ///< sample-and-hold group; empty: every row is a measurement
  int line = 0;      ///< of the file that says so; 0: not known
};

enum class TorqueKind { joint, motor, current };

struct Mapping {
  std::map<std::string, ColumnRule> columns;    ///< by our name
  std::map<std::string, double> keep_rows;      ///< keep rows where column == value
  std::optional<TorqueKind> torque;             ///< what the torque channels are, if declared
  std::map<std::string, double> torque_factor;  ///< per joint: gear (motor) or N m / A (current)

  // Where it was read, for what is found wrong with it beside a log and a robot.
  std::string file = "the mapping";
  int torque_line = 0;                                    ///< 0: not known
  std::map<std::string, int> keep_lines, factor_lines{};  ///< of keep_rows and torque_factor

  [[nodiscard]] Place at(const ColumnRule& rule) const { return {file, rule.line}; }
  [[nodiscard]] Place at_torque() const { return {file, torque_line}; }
  /// Of an entry of keep_rows; of one of torque_factor.
  [[nodiscard]] Place at_kept(const std::string& column) const;
  [[nodiscard]] Place at_factor(const std::string& joint) const;
};

/// Throws InputError.
[[nodiscard]] Mapping read_mapping_yaml(const std::string& path);

}  // namespace shapeid
