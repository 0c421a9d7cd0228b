// docs/claims.md against the tree: what it names exists, and what the tree cites is in it.
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "theorems.hpp"
#include "tree.hpp"

namespace {

namespace fs = std::filesystem;

struct Claim {
  std::string promised_in;
  std::vector<std::string> derived_in, theorems, tests, speed;
};

std::vector<std::string> items(const std::string& cell) {
  std::vector<std::string> list;
  std::istringstream words(cell);
  for (std::string word; words >> word;) {
    if (word.back() == ',') word.pop_back();
    if (word != "-") list.push_back(word);
  }
  return list;
}

std::map<std::string, Claim> claims() {
  std::map<std::string, Claim> found;
  std::istringstream lines(text_of(root / "docs/claims.md"));
  const std::regex row(
      R"(\| (C\d+) \| [^|]+ \| ([^|]+) \| ([^|]+) \| ([^|]+) \| ([^|]+) \| ([^|]+) \|)");
  for (std::string line; std::getline(lines, line);) {
    std::smatch m;
    if (std::regex_match(line, m, row)) {
      found[m[1]] = {m[2], items(m[3]), items(m[4]), items(m[5]), items(m[6])};
    }
  }
  return found;
}

/// Every "Suite.Name" of the test sources.
std::set<std::string> test_names() {
  std::set<std::string> names;
  const std::regex macro(R"((?:TEST|TEST_F|TEST_P|RC_GTEST_PROP)\(\s*(\w+),\s*(\w+))");
  for (const auto& file : fs::recursive_directory_iterator(root / "tests")) {
    if (file.path().extension() != ".cpp") continue;
    const std::string text = text_of(file.path());
    for (std::sregex_iterator m(text.begin(), text.end(), macro), end; m != end; ++m) {
      names.insert((*m)[1].str() + "." + (*m)[2].str());
    }
  }
  return names;
}

/// Ids that headers and proofs cite, as "Claim C3" or "Claims C4, C5", with the files that cite
/// them.
std::map<std::string, std::set<std::string>> citations() {
  std::map<std::string, std::set<std::string>> found;
  const std::regex cited(R"(Claims? (C\d+(?:, C\d+)*))"), id(R"(C\d+)");
  for (const char* folder : {"models", "reference", "fast", "diagnosis", "proofs"}) {
    for (const auto& file : fs::recursive_directory_iterator(root / folder)) {
      if (file.path().extension() != ".hpp" && file.path().extension() != ".v") continue;
      const std::string text = text_of(file.path());
      for (std::sregex_iterator m(text.begin(), text.end(), cited), end; m != end; ++m) {
        const std::string list = (*m)[1];
        for (std::sregex_iterator k(list.begin(), list.end(), id); k != end; ++k) {
          found[k->str()].insert(fs::relative(file.path(), root).string());
        }
      }
    }
  }
  return found;
}

TEST(Claims, NamesAgreeOnBothSides) {
  const auto stated = claims();
  const auto names = test_names();
  const auto cited = citations();
  ASSERT_FALSE(stated.empty());
  for (const auto& [id, claim] : stated) {
    SCOPED_TRACE(id);
    const auto found = cited.find(id);
    ASSERT_NE(found, cited.end()) << "no header and no proof cites it";
    EXPECT_TRUE(found->second.contains(claim.promised_in)) << claim.promised_in;
    for (const std::string& page : claim.derived_in) {
      EXPECT_TRUE(fs::exists(root / "docs" / page)) << page;
    }
    for (const std::string& test : claim.tests) EXPECT_TRUE(names.contains(test)) << test;
  }
  for (const auto& [id, files] : cited) {
    EXPECT_TRUE(stated.contains(id)) << id << " is cited in " << *files.begin();
  }
}

using ByClaim = std::map<std::string, std::set<std::string>>;

/// What the Coq files of proofs/ prove of a claim, by the claim's id.
ByClaim proved() {
  ByClaim found;
  for (const auto& file : fs::directory_iterator(root / "proofs")) {
    if (file.path().extension() != ".v") continue;
    const std::string text = text_of(file.path());
    for (const auto& [theorem, id] : theorems(file.path().stem().string(), text)) {
      EXPECT_NE(id, "") << theorem << " names no claim";
      found[id].insert(theorem);
    }
  }
  return found;
}

/// And the files of bounds that Gappa proves: the first line names the claim.
ByClaim bounded() {
  ByClaim found;
  const std::regex first(R"(^# Claim (C\d+)\. )");
  for (const auto& file : fs::directory_iterator(root / "proofs/rounding")) {
    const std::string text = text_of(file.path());
    std::smatch m;
    EXPECT_TRUE(std::regex_search(text, m, first)) << file.path() << " names no claim";
    found[m[1]].insert(fs::relative(file.path(), root / "proofs").string());
  }
  return found;
}

TEST(Claims, TheoremsAgreeOnBothSides) {
  ByClaim proofs = proved();
  for (const auto& [id, files] : bounded()) proofs[id].insert(files.begin(), files.end());
  EXPECT_FALSE(proofs.empty());
  for (const auto& [id, claim] : claims()) {
    const std::set<std::string> stated(claim.theorems.begin(), claim.theorems.end());
    EXPECT_EQ(stated, proofs[id]) << id;
    proofs.erase(id);
  }
  for (const auto& [id, theorem] : proofs) ADD_FAILURE() << *theorem.begin() << " proves " << id;
}

/// What the programs of tests/bench measure, as "Speed of Claims C4, C5." at their head.
ByClaim measured() {
  ByClaim found;
  const std::regex cited(R"(// Speed of Claims? (C\d+(?:, C\d+)*)\.)"), id(R"(C\d+)");
  for (const auto& file : fs::directory_iterator(root / "tests/bench")) {
    if (file.path().extension() != ".cpp") continue;
    const std::string text = text_of(file.path());
    std::smatch m;
    if (!std::regex_search(text, m, cited)) continue;
    const std::string list = m[1];
    for (std::sregex_iterator k(list.begin(), list.end(), id), end; k != end; ++k) {
      found[k->str()].insert("bench_" + file.path().stem().string());
    }
  }
  return found;
}

TEST(Claims, BenchmarksAgreeOnBothSides) {
  ByClaim programs = measured();
  EXPECT_FALSE(programs.empty());
  for (const auto& [id, claim] : claims()) {
    const std::set<std::string> stated(claim.speed.begin(), claim.speed.end());
    EXPECT_EQ(stated, programs[id]) << id;
    programs.erase(id);
  }
  for (const auto& [id, program] : programs) ADD_FAILURE() << *program.begin() << " cites " << id;
}

TEST(Proofs, TakeNothingWithoutProof) {
  for (const auto& file : fs::directory_iterator(root / "proofs")) {
    if (file.path().extension() != ".v") continue;
    for (const std::string& word : unproved(text_of(file.path()))) {
      ADD_FAILURE() << file.path().filename() << ": " << word;
    }
  }
}

/// The list that the compiled theorems are compared with names each of them, and none else.
TEST(Proofs, AssumptionsAreListedForEveryTheorem) {
  std::set<std::string> all, listed;
  for (const auto& [id, theorem] : proved()) all.insert(theorem.begin(), theorem.end());
  std::istringstream lines(text_of(root / "proofs/assumptions.txt"));
  for (std::string line; std::getline(lines, line);) listed.insert(line.substr(0, line.find(':')));
  EXPECT_EQ(all, listed);
}

/// What a page's headings are called in links, as GitHub does: small letters, digits, - and _.
std::set<std::string> anchors(const std::string& page) {
  std::set<std::string> found;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t title = line.find_first_not_of('#');
    if (title == 0 || title == std::string::npos || line[title] != ' ') continue;
    std::string anchor;
    for (const char c : line.substr(title + 1)) {
      const auto letter = static_cast<unsigned char>(c);
      if (c == ' ')
        anchor += '-';
      else if (std::isalnum(letter) != 0 || c == '-' || c == '_' || letter >= 0x80) {
        anchor += static_cast<char>(std::tolower(letter));
      }
    }
    found.insert(anchor);
  }
  return found;
}

/// Links between the pages of docs/ and the READMEs lead somewhere.
TEST(Documents, LinksLeadToFiles) {
  const std::regex link(R"(\]\(([^)#:]*)(?:#([^)]+))?\))");
  for (const auto& file : fs::recursive_directory_iterator(root)) {
    const std::string path = fs::relative(file.path(), root).string();
    if (file.path().extension() != ".md" || path.starts_with("build") || path.starts_with("out")) {
      continue;
    }
    const std::string text = text_of(file.path());
    for (std::sregex_iterator m(text.begin(), text.end(), link), end; m != end; ++m) {
      const bool here = (*m)[1].length() == 0;
      const fs::path page = here ? file.path() : file.path().parent_path() / (*m)[1].str();
      EXPECT_TRUE(fs::exists(page)) << path << " links to " << (*m)[1];
      if (!(*m)[2].matched || page.extension() != ".md" || !fs::exists(page)) continue;
      EXPECT_TRUE(anchors(text_of(page)).contains((*m)[2])) << path << " links to " << (*m)[0];
    }
  }
}

}  // namespace
