// The top of the tree: what stands there says how the project is read.
#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>

#include "shapeid/tests/house/tree.hpp"

namespace {

namespace fs = std::filesystem;

/// Whether a clone would not have it: what .gitignore names, and git's own.
bool is_of_this_machine(const std::string& name) {
  static const std::set<std::string> names = {".git", ".cache", "build", "out",
                                              "compile_commands.json"};
  return names.contains(name) || name.starts_with("build-");
}

TEST(Layout, TheTopOfTheTreeIsAsDesigned) {
  const std::set<std::string> wanted = {
      // what is read
      "app", "diagnosis", "docs", "fast", "fuzz", "models", "proofs", "reference", "tests",
      // what builds it
      ".ci", "CMakeLists.txt", "CMakePresets.json", "cmake", "run", "shapeidConfig.cmake.in",
      // what projects have
      ".clang-format", ".clang-tidy", ".gitignore", "CONTRIBUTING.md", "LICENSE", "README.md"};
  std::set<std::string> found;
  for (const auto& entry : fs::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    if (!is_of_this_machine(name)) found.insert(name);
  }
  EXPECT_EQ(found, wanted);
}

/// Programs and logs come in by mistake; nothing that is written by hand is as large.
TEST(Layout, NoFileIsLargerThanADocument) {
  constexpr std::uintmax_t largest = 1 << 19;  // bytes
  for (auto file = fs::recursive_directory_iterator(root); file != fs::end(file); ++file) {
    if (file.depth() == 0 && is_of_this_machine(file->path().filename().string())) {
      file.disable_recursion_pending();
      continue;
    }
    if (!file->is_regular_file()) continue;
    EXPECT_LE(file->file_size(), largest) << fs::relative(file->path(), root);
  }
}

}  // namespace
