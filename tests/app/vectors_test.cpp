// The vectors: what the tool writes, what a right program passes, and what every seeded bug fails.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

const std::string vectors_folder = SHAPEID_SOURCE_DIR "/tests/vectors";
const std::string example = "python3 " SHAPEID_SOURCE_DIR "/docs/examples/vectors.py";

bool has_python() { return std::system("python3 -c pass") == 0; }

CommandRun check(const std::string& program, const std::string& options = "") {
  return shapeid(fmt::format("vectors --check '{}' --json {}", program, options));
}

TEST(Vectors, AreWhatTheToolWrites) {
  const std::string made = scratch() + "/vectors";
  std::filesystem::create_directories(made);
  ASSERT_EQ(std::system((SHAPEID_MAKE_VECTORS " " + made).c_str()), 0);
  int files = 0;
  for (const auto& file : std::filesystem::directory_iterator(vectors_folder)) {
    if (file.path().extension() != ".json") continue;
    ++files;
    EXPECT_EQ(text_of(file.path()), text_of(made + "/" + file.path().filename().string()))
        << file.path();
  }
  EXPECT_EQ(files, 12);
}

TEST(Vectors, TheExampleInPythonPasses) {
  if (!has_python()) GTEST_SKIP() << "python3 is not installed";
  const CommandRun run = check(example);
  EXPECT_EQ(run.status, 0) << run.out << run.err;
}

TEST(Vectors, TheExampleInCppPasses) {
  const CommandRun run = check(SHAPEID_EXAMPLE_VECTORS);
  EXPECT_EQ(run.status, 0) << run.out << run.err;
}

/// The table in docs is made again: which vectors catch which bug, and none is caught by nothing.
TEST(Vectors, EverySeededBugIsCaughtAsTheTableSays) {
  if (!has_python()) GTEST_SKIP() << "python3 is not installed";
  const std::string made = scratch() + "/bugs.md";
  ASSERT_EQ(std::system(fmt::format("python3 {}/table.py {} > {}", vectors_folder,
                                    SHAPEID_BUILD_DIR "/shapeid", made)
                            .c_str()),
            0)
      << text_of(made);
  EXPECT_EQ(text_of(made), text_of(SHAPEID_SOURCE_DIR "/docs/bugs.md")) << "./run vectors";
}

TEST(Vectors, ProgramsThatDoNotAnswerAreSaid) {
  EXPECT_EQ(check("true").status, 2);
  expect_one_line(check("no_such_program_anywhere"), 2, "the shell finds no such program");
  // What a program says itself is kept, whether it answers or not.
  EXPECT_NE(check("echo why >&2; exit 127x").err.find("why\n"), std::string::npos);
  EXPECT_NE(check("echo why >&2; cat", "--kind moments").err.find("why\n"), std::string::npos);
  EXPECT_EQ(check("cat", "--kind nonsense").status, 2);
  const CommandRun echo = check("cat", "--kind moments");  // answers, but not the question
  EXPECT_EQ(echo.status, 1);
  const CommandRun chatty = check(R"(sed -u "s/.*/solving \xff/")", "--kind moments");
  EXPECT_EQ(chatty.status, 1);
  EXPECT_NE(chatty.out.find("not a JSON object: solving "), std::string::npos) << chatty.out;
  EXPECT_EQ(check("yes nonsense", "--kind moments").status, 1);
  // Answers before it is asked, and never reads: all vectors are more than a pipe holds.
  EXPECT_EQ(check("yes").status, 2);
  // Does not end at the end of its input, nor when it is told to.
  const CommandRun stubborn = check(R"(trap "" TERM; cat; sleep 1000)", "--kind moments");
  EXPECT_EQ(stubborn.status, 1) << stubborn.err;
}

/// A number where a list of one belongs, a list of another length, none at all.
TEST(Vectors, ListsThatAreNoneAreSaid) {
  const auto says = [](const std::string& answer, const std::string& kind) {
    return check("sed -u \"s/.*/" + answer + "/\"", "--kind " + kind).out;
  };
  const std::string number = says(R"({\"rank\":3,\"gram\":[1,2]})", "projection");
  EXPECT_NE(number.find("rank is not a list of 1 finite numbers"), std::string::npos) << number;
  EXPECT_NE(number.find("gram is a list of 2 numbers, expected 121"), std::string::npos) << number;
  const std::string nothing = says("{}", "masses");
  EXPECT_NE(nothing.find("masses is missing: a list of 4 finite"), std::string::npos) << nothing;
}

TEST(Vectors, ChangedFilesAreRefused) {
  const std::string copy = scratch() + "/changed";
  std::filesystem::remove_all(copy);
  std::filesystem::copy(vectors_folder, copy, std::filesystem::copy_options::recursive);
  const std::string text = text_of(copy + "/moments.json");
  scratch_file("changed/moments.json", text + " ");
  const CommandRun run = check("cat", "--vectors " + copy);
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("digest"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace shapeid::test
