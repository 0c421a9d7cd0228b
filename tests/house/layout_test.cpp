// The top of the tree: what stands there says how the project is read.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <regex>
#include <set>
#include <sstream>
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

/// Words in `backticks` in the rows of a page's tables, without the ending of a source or header.
std::set<std::string> files_in_tables(const std::string& page) {
  const std::regex name(R"(`([\w./]+?)(?:\.cpp|\.hpp|\.h)?`)");
  std::set<std::string> names;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with('|')) continue;
    for (std::sregex_iterator m(line.begin(), line.end(), name), end; m != end; ++m) {
      names.insert((*m)[1].str());
    }
  }
  return names;
}

/// Who reads a folder's README learns of every file what it is for.
TEST(Layout, EverySourceIsInATableOfItsFolder) {
  for (const char* folder : {"app", "diagnosis", "diagnosis/effects", "fast", "models",
                             "models/simbody", "proofs/certificate", "reference"}) {
    const std::set<std::string> listed = files_in_tables(text_of(root / folder / "README.md"));
    EXPECT_FALSE(listed.empty()) << folder;
    std::set<std::string> missing;
    for (const auto& file : fs::directory_iterator(root / folder)) {
      const std::string ending = file.path().extension().string();
      if (ending != ".cpp" && ending != ".hpp" && ending != ".h") continue;
      const std::string name = file.path().stem().string();
      if (!listed.contains(name)) missing.insert(name);
    }
    for (const std::string& name : missing) {
      ADD_FAILURE() << folder << "/README.md does not list " << name;
    }
  }
}

}  // namespace
