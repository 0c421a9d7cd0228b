#include "shapeid/tests/app/command.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>

#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

namespace fs = std::filesystem;

/// Whether a file is there and was written after the command and all files of the bundled robots.
bool is_of_this_command(const fs::path& file) {
  std::error_code missing;
  const fs::file_time_type written = fs::last_write_time(file, missing);
  if (missing || written <= fs::last_write_time(SHAPEID_BUILD_DIR "/shapeid")) return false;
  return std::none_of(
      fs::directory_iterator(robots), fs::directory_iterator(),
      [&](const fs::directory_entry& of_robot) { return written <= of_robot.last_write_time(); });
}

}  // namespace

const std::string& scratch() {
  static const std::string folder = [] {
    const auto path =
        fs::path(SHAPEID_BUILD_DIR) / "scratch" / fmt::format("test_app.{}", ::getpid());
    fs::remove_all(path);
    fs::create_directories(path);
    return path.string();
  }();
  return folder;
}

std::string scratch_file(const std::string& name, const std::string& text) {
  std::string path = scratch() + "/" + name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::string command(const std::string& arguments) {
  return fmt::format("'{}/shapeid' {}", SHAPEID_BUILD_DIR, arguments);
}

std::string in_bash(const std::string& line) { return fmt::format("bash -c \"{}\"", line); }

CommandRun program(const std::string& line, const std::string& input) {
  const std::string out = scratch() + "/stdout", err = scratch() + "/stderr";
  const std::string whole =
      fmt::format("cd '{}' && {} >'{}' 2>'{}' <'{}'", scratch(), line, out, err, input);
  const int status = std::system(whole.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out), text_of(err)};
}

CommandRun shapeid(const std::string& arguments, const std::string& input) {
  return program(command(arguments), input);
}

nlohmann::json diagnosed(const std::string& arguments) {
  const CommandRun run = shapeid("diagnose --json " + arguments);
  EXPECT_EQ(run.status, 0) << run.err;
  return run.status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
}

std::string simulated_log(const std::string& name, const std::string& arguments) {
  const fs::path folder = fs::path(SHAPEID_BUILD_DIR) / "scratch" / "simulated";
  fs::create_directories(folder);
  const fs::path kept = folder / (arguments + name.substr(name.find('.')));
  // Two that ask at once both simulate: the command writes beside and renames.
  if (!is_of_this_command(kept)) {
    const CommandRun run = shapeid(fmt::format("simulate {} --out '{}'", arguments, kept.string()));
    EXPECT_EQ(run.status, 0) << run.err;
  }
  std::string path = scratch() + "/" + name;
  fs::copy_file(kept, path, fs::copy_options::overwrite_existing);
  return path;
}

std::ptrdiff_t lines_said(const CommandRun& run) {
  std::ptrdiff_t lines = 0;
  std::istringstream text(run.err);
  for (std::string line; std::getline(text, line);) {
    if (run.status != 1 || !line.starts_with("note: ")) ++lines;
  }
  return lines;
}

void expect_one_line(const CommandRun& run, int status, const std::string& words) {
  // Not all of what a command says that prints without end.
  const std::string said = run.err.substr(0, 1000);
  EXPECT_EQ(run.status, status) << said;
  EXPECT_EQ(lines_said(run), 1) << said;
  EXPECT_NE(run.err.find(words), std::string::npos) << said;
}

}  // namespace shapeid::test
