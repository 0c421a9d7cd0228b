// Another program, asked by pipe: a line in, a line out.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <string_view>

namespace shapeid::app {

class ForeignProgram {
 public:
  /// Starts `command` through the shell. Throws InputError if that is not possible.
  explicit ForeignProgram(const std::string& command);
  /// Closes its input, and ends it if it does not end by itself.
  ~ForeignProgram();
  ForeignProgram(const ForeignProgram&) = delete;
  ForeignProgram& operator=(const ForeignProgram&) = delete;

  /// Writes the line and reads one. Throws InputError if the program ends or says nothing for
  /// `patience` milliseconds.
  [[nodiscard]] std::string ask(const std::string& line, int patience = 30000);

 private:
  void write_some(std::string_view& question);
  void read_some();
  void hear();
  void pass_on();
  [[nodiscard]] std::optional<int> ended_by_itself();
  [[noreturn]] void fail_ended(const char* how);

  std::string command_;
  pid_t child_ = -1;
  int to_ = -1, from_ = -1;
  int errors_ = -1;  ///< its standard error
  bool answered_ = false;
  std::string complaint_;  ///< what it said there before its first answer
  std::string unread_;
};

}  // namespace shapeid::app
