#include "shapeid/tests/app/command.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace shapeid::test {

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

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
  const std::string path = scratch() + "/" + name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

CommandRun program(const std::string& line, const std::string& input) {
  const std::string out = scratch() + "/stdout", err = scratch() + "/stderr";
  const std::string whole =
      fmt::format("cd '{}' && {} >'{}' 2>'{}' <'{}'", scratch(), line, out, err, input);
  const int status = std::system(whole.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
}

CommandRun shapeid(const std::string& arguments, const std::string& input) {
  return program(fmt::format("'{}/shapeid' {}", SHAPEID_BUILD_DIR, arguments), input);
}

}  // namespace shapeid::test
