// What can be wrong that is not a defect of ours: the input, or the question asked of it.
#pragma once

#include <stdexcept>
#include <string>

namespace shapeid {

/// Where in a file something is wrong. Line and column count from 1; 0 means "not known".
struct Place {
  std::string file;
  int line = 0;
  std::string column{};  ///< column name or number of a table; empty where there is none
};

/// "robot.urdf:12: " or "log.csv:7, column tau.knee: ", ready to stand before a message.
[[nodiscard]] std::string describe(const Place& place);

/// Bad input: one line that names the place, what is wrong, and what would be right. Exit status 2.
class InputError : public std::runtime_error {
 public:
  InputError(const Place& place, const std::string& wrong, const std::string& right);

  /// Bad input that has no file, such as an option of the command.
  InputError(const std::string& wrong, const std::string& right);
};

/// Data that cannot answer the question put to it, with a stable code such as "not-excited".
/// Exit status 1.
class Refusal : public std::runtime_error {
 public:
  Refusal(std::string code, const std::string& reason);

  [[nodiscard]] const std::string& code() const { return code_; }
  /// What what() says behind the code.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::string code_, reason_;
};

}  // namespace shapeid
