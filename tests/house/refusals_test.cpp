// docs/refusals.md against the sources: every code that is given is there, and none that is not.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "tree.hpp"

namespace {

namespace fs = std::filesystem;

std::set<std::string> given() {
  std::set<std::string> codes;
  const std::regex thrown(R"rx(\bRefusal\(\s*"([a-z-]+)")rx");
  for (const char* folder : {"models", "reference", "fast", "diagnosis", "app", "proofs"}) {
    for (const auto& file : fs::recursive_directory_iterator(root / folder)) {
      if (file.path().extension() != ".cpp" && file.path().extension() != ".hpp") continue;
      const std::string text = text_of(file.path());
      for (std::sregex_iterator m(text.begin(), text.end(), thrown), end; m != end; ++m) {
        codes.insert((*m)[1].str());
      }
    }
  }
  return codes;
}

std::set<std::string> documented() {
  std::set<std::string> codes;
  const std::regex row(R"(\| `([a-z-]+)` \|.*)");
  std::istringstream lines(text_of(root / "docs/refusals.md"));
  std::smatch m;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, m, row)) codes.insert(m[1].str());
  }
  return codes;
}

TEST(Refusals, AreAllDocumentedAndNoOthers) {
  EXPECT_GT(given().size(), 10U);
  EXPECT_EQ(documented(), given());
}

}  // namespace
