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

#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {

const std::string& scratch() {
  static const std::string folder = [] {
    const auto path = std::filesystem::path(SHAPEID_BUILD_DIR) / "scratch" /
                      fmt::format("test_app.{}", ::getpid());
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
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

void expect_one_line(const CommandRun& run, int status, const std::string& words) {
  // Not all of what a command says that prints without end.
  const std::string said = run.err.substr(0, 1000);
  EXPECT_EQ(run.status, status) << said;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << said;
  EXPECT_NE(run.err.find(words), std::string::npos) << said;
}

}  // namespace shapeid::test
