// Runs the command as a user would.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace shapeid::test {

/// The bundled robots, and the options that name the quadruped's files.
inline const std::string robots = SHAPEID_SOURCE_DIR "/models/robots/";
inline const std::string quadruped_files =
    fmt::format("--robot {0}quadruped.urdf --robot-yaml {0}quadruped.robot.yaml", robots);
inline const std::string quadruped_shapes = fmt::format("--shapes {}quadruped.shapes.yaml", robots);

struct CommandRun {
  int status = -1;
  std::string out, err;
};

/// `shapeid ARGUMENTS` through the shell, in a folder of its own for files. `input`: file that is
/// its standard input.
[[nodiscard]] CommandRun shapeid(const std::string& arguments,
                                 const std::string& input = "/dev/null");

/// What `shapeid diagnose --json ARGUMENTS` prints; expects that it succeeds.
[[nodiscard]] nlohmann::json diagnosed(const std::string& arguments);

/// What the shell calls for `shapeid ARGUMENTS`, as a part of a longer line.
[[nodiscard]] std::string command(const std::string& arguments);

/// A line for bash, which can do what the plain shell cannot.
[[nodiscard]] std::string in_bash(const std::string& line);

/// The same as shapeid() for any program.
[[nodiscard]] CommandRun program(const std::string& line, const std::string& input = "/dev/null");

/// A folder that is made anew for every test program and that tests may write into.
[[nodiscard]] const std::string& scratch();

/// Writes a file into scratch() and returns its path.
std::string scratch_file(const std::string& name, const std::string& text);

/// Writes into scratch() what `shapeid simulate ARGUMENTS` does: the first test program that asks
/// for it waits for the simulation, all others copy what that one kept beside the build. `name`
/// says how it is written (NAME.csv, NAME.csv.gz); arguments name no files. Returns the path;
/// expects that the command succeeds.
std::string simulated_log(const std::string& name, const std::string& arguments);

/// How many lines a command said on standard error. Notes stand before a refusal (exit status 1),
/// and do not count.
[[nodiscard]] std::ptrdiff_t lines_said(const CommandRun& run);

/// Expects that the command said what is wrong in one line that holds `words`.
void expect_one_line(const CommandRun& run, int status, const std::string& words);

}  // namespace shapeid::test
