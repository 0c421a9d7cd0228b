// Logs out: CSV, gzipped if the name ends in .gz, with numbers that read back exactly.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace shapeid {

/// Writes beside `path` and renames into place at close(), so that a half-written log never
/// replaces a good one; without close() nothing appears.
class LogWriter {
 public:
  /// Throws InputError if the place cannot be written, or for column names that LogReader would
  /// refuse (none, empty, twice).
  LogWriter(const std::string& path, std::vector<std::string> columns);
  ~LogWriter();
  LogWriter(LogWriter&&) noexcept;
  LogWriter& operator=(LogWriter&&) noexcept;
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// One number a column, as shortest decimals that round-trip. NaN writes an empty field: not
  /// measured. Throws Defect for another count or an infinity, InputError if the disk is full.
  void write(const std::vector<double>& values);
  /// Puts the log in its place. Throws InputError if that fails.
  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace shapeid
