// What Gappa proves is about the code that stands there: each file of proofs/rounding quotes it.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <sstream>
#include <string>

#include "tree.hpp"

namespace {

namespace fs = std::filesystem;

/// "# ..., models/cuboid.cpp:" names the source, and lines of "#   code" quote it.
TEST(Rounding, QuotesTheCodeItIsAbout) {
  const std::regex names(R"(^# .*\b(models/\w+\.cpp):$)"), quotes(R"(^#   (.*))");
  for (const auto& file : fs::directory_iterator(root / "proofs/rounding")) {
    SCOPED_TRACE(file.path());
    std::istringstream lines(text_of(file.path()));
    std::string source;
    int quoted = 0;
    for (std::string line; std::getline(lines, line);) {
      std::smatch m;
      if (std::regex_match(line, m, names)) source = text_of(root / m[1].str());
      if (!std::regex_match(line, m, quotes)) continue;
      const std::string code = m[1].str().substr(m[1].str().find_first_not_of(' '));
      EXPECT_NE(source.find(code), std::string::npos) << code;
      ++quoted;
    }
    EXPECT_GT(quoted, 0);
  }
}

}  // namespace
