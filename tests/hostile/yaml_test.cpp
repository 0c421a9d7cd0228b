// YAML files made to exhaust a reader: aliases of aliases, depth, keys without end.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "shapeid/models/log.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/tests/hostile/refused.hpp"
#include "shapeid/tests/robot/two_link_robot.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::refusal, test::repeated, test::says;

/// What each reader of YAML says to the text.
std::vector<std::string> refusals(const std::string& text) {
  const test::ScratchFolder folder;
  const std::string path = folder.write("x.yaml", text);
  Robot robot = test::two_link_robot();
  return {refusal([&] { static_cast<void>(read_shapes_yaml(path, robot)); }),
          refusal([&] { static_cast<void>(read_robot_yaml(path, robot)); }),
          refusal([&] { static_cast<void>(read_mapping_yaml(path)); })};
}

void expect_refused(const std::string& text, const std::string& words = "x.yaml") {
  for (const std::string& message : refusals(text)) {
    EXPECT_TRUE(says(message, words)) << message;
    EXPECT_TRUE(says(message, "; ")) << message;
  }
}

TEST(HostileYaml, AliasBomb) {
  std::string text = "a0: &a0 [ha]\n";
  for (int i = 1; i < 30; ++i) {
    text += fmt::format("a{0}: &a{0} [{1}*a{2}]\n", i, repeated(fmt::format("*a{}, ", i - 1), 9),
                        i - 1);
  }
  expect_refused(text);
}

// Where a list of numbers, a map or a scalar is meant, and at any depth that fits into the file.
TEST(HostileYaml, AThousandTimesDeep) {
  for (const std::string bracket : {"[", "{a: ", "- ", "? "}) {
    for (const std::size_t deep : {600U, 20000U, 200000U}) {
      expect_refused("trunk: " + repeated(bracket, deep));
      expect_refused(repeated(bracket, deep));
    }
  }
  std::string indented;  // block maps, each a column further in
  for (std::size_t i = 0; i < 1200; ++i) indented += std::string(i, ' ') + "a:\n";
  expect_refused(indented);
}

TEST(HostileYaml, AnAliasOfWhatItStandsIn) { expect_refused("trunk: &a [*a]\nimu: *a\n"); }

TEST(HostileYaml, KeysThatAreNoWords) {
  expect_refused("[1, 2]: {}\n");
  expect_refused("? {a: 1}\n: 2\n");
  expect_refused("~: 1\n");
  expect_refused("columns: {[a]: b}\nimu: {[a]: b}\ntrunk: {[a]: b}\n");
  expect_refused("\"\\e[2J\": 1\n");
}

TEST(HostileYaml, AHundredThousandKeys) {
  std::string text;
  for (int i = 0; i < 100000; ++i) text += fmt::format("k{}: 1\n", i);
  expect_refused(text);
}

// The time that a megabyte of them takes is that of some hundred thousand lines.
TEST(HostileYaml, ColumnsByTheTenThousand) {
  const test::ScratchFolder folder;
  std::string text = "columns:\n";
  for (int i = 0; i < 80000; ++i) text += fmt::format(" k{}: a\n", i);
  EXPECT_EQ(read_mapping_yaml(folder.write("m.yaml", text)).columns.size(), 80000U);
}

TEST(HostileYaml, DocumentsHaveTheirMarkers) {
  const test::ScratchFolder folder;
  const auto read = [&](const std::string& text) {
    return refusal([&] { static_cast<void>(read_mapping_yaml(folder.write("m.yaml", text))); });
  };
  const std::string page = "columns: {time: t}\n";
  EXPECT_EQ(read("%YAML 1.2\n---\n" + page), "accepted");
  EXPECT_EQ(read("---\n" + page + "...\n# the end\n"), "accepted");
  EXPECT_TRUE(says(read(page + "...\nkeep_rows: {a: 1}\n"), "m.yaml:3: a second document"));
  EXPECT_TRUE(says(read(page + "---\n" + page), "m.yaml:2: a second document"));
}

TEST(HostileYaml, LargerThanAnyPage) {
  expect_refused(std::string((std::size_t{1} << 20) + 1, '#'), "larger than 1048576 bytes");
}

TEST(HostileYaml, NumbersAtTheEndsOfDouble) {
  const test::ScratchFolder folder;
  const Robot robot = test::two_link_robot();
  const auto shapes = [&](const std::string& side) {
    const std::string path =
        folder.write("s.yaml", "trunk:\n  - {kind: cuboid, size: [1, 1, " + side + "]}\n");
    return refusal([&] { static_cast<void>(read_shapes_yaml(path, robot)); });
  };
  EXPECT_EQ(shapes("1e-3"), "accepted");
  for (const char* side : {"1e400", "1e-400", ".inf", ".nan", "nan", "0x10", "1_000", "1e308",
                           "1e200", "5e-324", "1e-200", "-1", "0"}) {
    EXPECT_TRUE(says(shapes(side), "s.yaml:2")) << side << ": " << shapes(side);
  }
}

TEST(HostileYaml, ByteOrderMarkAndCarriageReturns) {
  const test::ScratchFolder folder;
  const std::string path = folder.write(
      "s.yaml", "\xEF\xBB\xBFtrunk:\r\n  - {kind: cuboid, size: [1, 2, 3]}\r\nleg: known\r\n");
  EXPECT_EQ(read_shapes_yaml(path, test::two_link_robot()).shapes.size(), 1U);
}

}  // namespace
}  // namespace shapeid
