// The top of the tree: what stands there says how the project is read.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "shapeid/tests/house/tree.hpp"

namespace {

namespace fs = std::filesystem;

/// What git has of the tree; nothing where there is no git or no clone.
std::vector<std::string> tracked_files() {
  const std::string command = "git -C '" + root.string() + "' ls-files -z 2>/dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  std::vector<std::string> names;
  std::string name;
  for (int c = 0; pipe != nullptr && (c = std::fgetc(pipe)) != EOF;) {
    if (c != '\0') {
      name.push_back(static_cast<char>(c));
    } else {
      names.push_back(std::move(name));
      name.clear();
    }
  }
  if (pipe != nullptr) pclose(pipe);
  return names;
}

TEST(Layout, TheTopOfTheTreeIsAsDesigned) {
  const std::vector<std::string> files = tracked_files();
  if (files.empty()) GTEST_SKIP() << "no clone, or no git";
  const std::set<std::string> wanted = {
      // what is read
      "app", "diagnosis", "docs", "fast", "fuzz", "models", "proofs", "reference", "tests",
      // what builds it
      ".ci", "CMakeLists.txt", "CMakePresets.json", "cmake", "run", "shapeidConfig.cmake.in",
      // what projects have
      ".clang-format", ".clang-tidy", ".gitignore", "CONTRIBUTING.md", "LICENSE", "README.md"};
  std::set<std::string> found;
  for (const std::string& file : files) found.insert(file.substr(0, file.find('/')));
  EXPECT_EQ(found, wanted);
}

/// Programs and logs come in by mistake; nothing that is written by hand is as large.
TEST(Layout, NoFileIsLargerThanADocument) {
  const std::vector<std::string> files = tracked_files();
  if (files.empty()) GTEST_SKIP() << "no clone, or no git";
  constexpr std::uintmax_t largest = 1 << 19;  // bytes
  for (const std::string& file : files) {
    if (fs::is_regular_file(root / file)) {
      EXPECT_LE(fs::file_size(root / file), largest) << file;
    }
  }
}

}  // namespace
