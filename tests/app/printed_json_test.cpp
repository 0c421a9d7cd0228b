// What verbs print with --json has the keys that docs/formats/printed.md says, and no others.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

using nlohmann::json;
using Names = std::set<std::string>;

const std::string page_name = SHAPEID_SOURCE_DIR "/docs/formats/printed.md";

/// Behind `words` up to the next table's end: what is there in backquotes, of the first column
/// alone (keys of the document itself) or of all (of what is in it, too).
Names documented(const std::string& words, bool first_column) {
  const std::string page = text_of(page_name);
  const std::size_t place = page.find(words);
  EXPECT_NE(place, std::string::npos) << words;
  const std::size_t begin = page.find("|---|---|\n", place) + 10;
  std::istringstream table(page.substr(begin, page.find("\n\n", begin) - begin));
  Names names;
  const std::regex name("`([a-z_]+)`");
  for (std::string row; std::getline(table, row);) {
    if (first_column) row = row.substr(0, row.find('|', 1));
    for (std::sregex_iterator match(row.begin(), row.end(), name), end; match != end; ++match) {
      names.insert((*match)[1]);
    }
  }
  return names;
}

void expect_documented(const std::string& words, const std::string& arguments) {
  const CommandRun run = shapeid(arguments);
  ASSERT_TRUE(json::accept(run.out)) << run.out << run.err;
  const json document = json::parse(run.out);
  const Names anywhere = documented(words, false);
  Names keys;
  for (const auto& [key, value] : document.items()) {
    keys.insert(key);
    if (!value.is_array()) continue;
    for (const json& entry : value) {
      if (!entry.is_object()) continue;
      for (const auto& item : entry.items())
        EXPECT_TRUE(anywhere.contains(item.key())) << item.key();
    }
  }
  EXPECT_EQ(keys, documented(words, true)) << arguments;
}

TEST(PrintedJson, HasTheKeysThatAreDocumented) {
  expect_documented("Of a URDF:", fmt::format("inspect --json {}quadruped.urdf", robots));
  scratch_file("impossible.urdf",
               "<robot name=\"r\"><link name=\"a\"><inertial><mass value=\"-1\"/>"
               "<inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>"
               "</link></robot>");
  expect_documented("Of a URDF:", "inspect --json impossible.urdf");
  scratch_file("columns.csv", "time,a,b\n0,1,\n1,2,\n");
  expect_documented("Of a log:", "inspect --json columns.csv");
  expect_documented(
      "## convert",
      "convert --json --from pinocchio --to drake 2 0.5 -1 1.5 4 0.125 5 -0.375 0.25 6");
  expect_documented("## simulate", "simulate --json --seconds 0.5 --out short.csv");
  expect_documented("Of a log as", fmt::format("inspect --json {} short.csv", quadruped_files));
}

TEST(PrintedJson, OfAVerdictHasTheKeysThatAreDocumented) {
  json problem = {{"format", "shapeid-problem-1"},
                  {"free_links", 1},
                  {"Y", {{1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}}},
                  {"F", {3.0}},
                  {"W", {1.0}},
                  {"V", {0.5}},
                  {"lambda", 0.0},
                  {"mass_bound", 8.0}};
  for (const double moment : {1.0, 0.0, 0.0, 0.0, 0.25, 0.0, 0.0, 0.25, 0.0, 0.5}) {
    problem["U"].push_back({moment});
  }
  const json answer = {{"format", "shapeid-answer-1"},
                       {"problem_digest", ""},
                       {"masses", {3.0}},
                       {"parameters", {3.0, 0.0, 0.0, 0.0, 0.75, 0.0, 0.0, 0.75, 0.0, 1.5}},
                       {"objective", 0.0}};
  scratch_file("stated.json", problem.dump());
  scratch_file("answered.json", answer.dump());
  expect_documented("## certify", "certify --json stated.json answered.json");
}

/// By whatever name: what else is said would stand in the log.
TEST(PrintedJson, OfASimulationIsNoPartOfTheLog) {
  for (const char* form : {"", "--json "}) {
    const std::string line = fmt::format("simulate {}--seconds 0.2 --out /dev/stdout", form);
    const CommandRun run = program(in_bash(command(line) + " | cat"));
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(run.out.starts_with("time,")) << run.out.substr(0, 100);
    EXPECT_EQ(run.out.find("samples"), std::string::npos);
    EXPECT_NE(run.err.find("samples"), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace shapeid::test
