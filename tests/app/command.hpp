// Runs the command as a user would.
#pragma once

#include <string>

namespace shapeid::test {

struct CommandRun {
  int status = -1;
  std::string out, err;
};

/// `shapeid ARGUMENTS` through the shell, in a folder of its own for files. `input`: file that is
/// its standard input.
[[nodiscard]] CommandRun shapeid(const std::string& arguments,
                                 const std::string& input = "/dev/null");

/// The same for any program.
[[nodiscard]] CommandRun program(const std::string& line, const std::string& input = "/dev/null");

/// A folder that is made anew for every test program and that tests may write into.
[[nodiscard]] const std::string& scratch();

/// Writes a file into scratch() and returns its path.
std::string scratch_file(const std::string& name, const std::string& text);

[[nodiscard]] std::string read_file(const std::string& path);

}  // namespace shapeid::test
