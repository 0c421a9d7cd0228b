// docs/derivations/symbols.md against the code and against the other chapters.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tree.hpp"

namespace {

namespace fs = std::filesystem;
using Letters = std::set<std::string>;

const fs::path chapters = root / "docs/derivations";

/// Cells of the table rows of a page whose first cell matches.
std::vector<std::vector<std::string>> rows(const fs::path& page, const std::string& first) {
  std::vector<std::vector<std::string>> found;
  std::istringstream lines(text_of(page));
  for (std::string line; std::getline(lines, line);) {
    if (!std::regex_search(line, std::regex("^\\| " + first))) continue;
    std::vector<std::string> cells;
    std::istringstream rest(line.substr(1));
    for (std::string cell; std::getline(rest, cell, '|');) cells.push_back(cell);
    found.push_back(cells);
  }
  return found;
}

std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator m(text.begin(), text.end(), expression), end; m != end; ++m) {
    found.push_back((*m)[1]);
  }
  return found;
}

/// Single letters, and Greek ones by name, of all formulas in a text. Indices, words, and the d of
/// integrals are none.
Letters letters(const std::string& text) {
  static const std::set<std::string> greek = {
      "alpha", "beta", "gamma", "delta", "varepsilon", "theta", "kappa", "lambda", "mu",
      "nu",    "rho",  "sigma", "tau",   "phi",        "omega", "Phi",   "Sigma",  "Delta"};
  const std::string prose = std::regex_replace(text, std::regex("```[^`]*```|`[^`]*`"), "");
  Letters found;
  for (std::string formula : matches(prose, R"(\$\$?([^$]+)\$\$?)")) {
    for (const char* nothing : {R"(\\(text|operatorname|mathrm|mathbb|begin|end|tag)\{[^}]*\})",
                                R"(\^T)", R"(_(\{[^}]*\}|\\[a-zA-Z]+|.))"}) {
      formula = std::regex_replace(formula, std::regex(nothing), " ");
    }
    for (const std::string& name : matches(formula, R"((\\?[a-zA-Z]+))")) {
      if (name[0] != '\\') {
        for (const char letter : name) found.insert(std::string(1, letter));
      } else if (greek.contains(name.substr(1))) {
        found.insert(name.substr(1));
      }
    }
  }
  return found;
}

/// Letters of the table, and by chapter those of its own.
Letters common_letters() {
  Letters found;
  for (const auto& row : rows(chapters / "symbols.md", R"(\$)")) found.merge(letters(row[0]));
  return found;
}

std::map<std::string, Letters> own_letters() {
  std::map<std::string, Letters> found;
  for (const auto& row : rows(chapters / "symbols.md", R"([a-z-]+\.md )")) {
    std::istringstream words(row[1]);
    found[matches(row[0], R"(([a-z-]+\.md))").front()] = {std::istream_iterator<std::string>(words),
                                                          {}};
  }
  return found;
}

std::string joined(const Letters& list) {
  std::string text;
  for (const std::string& letter : list) text += letter + " ";
  return text;
}

Letters without(const Letters& all, const Letters& some) {
  Letters rest;
  std::set_difference(all.begin(), all.end(), some.begin(), some.end(),
                      std::inserter(rest, rest.end()));
  return rest;
}

TEST(Symbols, AreThoseOfTheCode) {
  const auto table = rows(chapters / "symbols.md", R"(\$)");
  EXPECT_GT(table.size(), 30U);
  for (const auto& row : table) {
    ASSERT_EQ(row.size(), 6U) << row[0];
    const std::vector<std::string> names = matches(row[4], "`([^`]+)`"),
                                   files = matches(row[5], R"(([a-z_/]+\.hpp))");
    ASSERT_FALSE(names.empty() || files.empty()) << row[0];
    std::string code;
    for (const std::string& file : files) {
      ASSERT_TRUE(fs::exists(root / file)) << row[0] << file;
      code += text_of(root / file);
    }
    for (const std::string& name : names) {
      EXPECT_TRUE(std::regex_search(code, std::regex("\\b" + name + "\\b")))
          << row[0] << ": no " << name << " in" << row[5];
    }
  }
}

TEST(Symbols, OfEveryPageAreInTheTable) {
  const Letters common = common_letters();
  std::map<std::string, Letters> own = own_letters();
  for (const auto& file : fs::directory_iterator(chapters)) {
    const std::string name = file.path().filename().string();
    if (file.path().extension() != ".md" || name == "symbols.md") continue;
    const Letters used = letters(text_of(file.path()));
    Letters known = common;
    known.insert(own[name].begin(), own[name].end());
    EXPECT_EQ(joined(without(used, known)), "") << name << " uses letters that are in no table";
    EXPECT_EQ(joined(without(own[name], used)), "") << name << " does not use its own letters";
  }
}

/// A formula is a letter of its own, not its indices nor its words.
TEST(Symbols, AreReadFromFormulas) {
  EXPECT_EQ(letters(R"(so $\bar\Phi_k = \sum_j u_j m_{ij}^T$ and `$x$`)"),
            (Letters{"Phi", "m", "u"}));
  EXPECT_EQ(letters("$$\\int x \\,\\mathrm{d}m \\text{ for all } y$$ z"), (Letters{"m", "x", "y"}));
}

TEST(Symbols, EveryChapterIsInTheReadingOrder) {
  const std::string order = text_of(chapters / "README.md");
  for (const auto& file : fs::directory_iterator(chapters)) {
    const std::string name = file.path().filename().string();
    if (file.path().extension() != ".md" || name == "README.md") continue;
    EXPECT_NE(order.find("](" + name), std::string::npos) << name;
  }
}

}  // namespace
