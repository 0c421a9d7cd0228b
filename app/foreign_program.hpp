// Another program, asked by pipe: a line in, a line out.
#pragma once

#include <sys/types.h>

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
  void write_some(std::string_view& question) const;
  void read_some();

  std::string command_;
  pid_t child_ = -1;
  int to_ = -1, from_ = -1;
  std::string unread_;
};

}  // namespace shapeid::app
