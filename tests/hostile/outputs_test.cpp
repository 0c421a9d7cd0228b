// Places that cannot be written to: full disks, links, devices, folders. What was there before
// stays whole, and the command says in one line what went wrong.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>

#include "shapeid/models/error.hpp"
#include "shapeid/models/file_output.hpp"
#include "shapeid/models/log_writer.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/hostile/refused.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* ten_numbers =
    "convert --from pinocchio --to drake 2 0.2 -0.4 0.6 1 0.1 1.2 "
    "-0.2 0.3 1.4";

/// Whether something half-written was left behind.
bool leftovers() {
  return std::any_of(fs::directory_iterator(scratch()), fs::directory_iterator(),
                     [](const auto& entry) { return says(entry.path().string(), ".part"); });
}

/// The command with its standard output elsewhere, or limited, as the shell can do it.
CommandRun run_in_shell(const std::string& before, const std::string& arguments,
                        const std::string& after) {
  return program(in_bash(fmt::format("{} {} {}", before, command(arguments), after)));
}

TEST(HostileOutputs, StandardOutputThatIsFull) {
  expect_one_line(run_in_shell("", ten_numbers, ">/dev/full"), 2, "standard output");
  expect_one_line(run_in_shell("", ten_numbers, ">&-"), 2, "standard output");
  expect_one_line(run_in_shell("", "--help", ">/dev/full"), 2, "standard output");
}

/// Where nobody can read what is said, the status still tells. (It was an abort: `2>&1 | head`.)
TEST(HostileOutputs, StandardErrorThatIsClosedOrFull) {
  const std::string warns = "convert --from pinocchio --to drake -1 0 0 0 1 0 1 0 0 1";
  for (const std::string where : {"2>/dev/full", "2>&-"}) {
    EXPECT_EQ(run_in_shell("", "inspect none.csv", where).status, 2) << where;
    EXPECT_EQ(run_in_shell("", "no-such-verb", where).status, 2) << where;
    EXPECT_EQ(run_in_shell("", warns, where).status, 0) << where;
    const CommandRun wrote = run_in_shell("", "simulate --seconds 0.2 --out said.csv", where);
    EXPECT_EQ(wrote.status, 0) << where;
  }
}

/// Under nohup a program outlives its terminal.
TEST(HostileOutputs, AnIgnoredHangupStaysIgnored) {
  ASSERT_EQ(shapeid("simulate --seconds 0.2 --out followed.csv").status, 0);
  const CommandRun run = program(in_bash(fmt::format(
      "trap '' HUP; {} & p=$!; sleep 0.5; kill -HUP $p; sleep 0.2; kill -0 $p && echo alive; "
      "kill -INT $p; kill -TERM $p; wait $p",
      command("track --whole-body --follow followed.csv " + quadruped_files +
              " >/dev/null 2>&1"))));
  EXPECT_EQ(run.out, "alive\n") << run.err;
}

// A limit on the size of files stands for a full disk: writing stops in the middle.
TEST(HostileOutputs, ADiskThatIsFull) {
  for (const std::string name : {"full.csv", "full.csv.gz"}) {
    scratch_file(name, "the one from before\n");
    const CommandRun run = run_in_shell("trap '' XFSZ; ulimit -f 2;",
                                        "simulate --seconds 0.2 --out " + name, ">/dev/null");
    expect_one_line(run, 2, name + ": cannot be written");
    EXPECT_EQ(text_of(scratch() + "/" + name), "the one from before\n");
    EXPECT_FALSE(leftovers());
  }
}

TEST(HostileOutputs, LinksAreFollowedAndStay) {
  const std::string target = scratch_file("target.txt", "old");
  const std::string link = scratch() + "/link.txt";
  fs::create_symlink("target.txt", link);
  write_file(link, "new");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(text_of(target), "new");

  const std::string nowhere = scratch() + "/nowhere.txt";
  fs::create_symlink(scratch() + "/none/there.txt", nowhere);
  write_file(nowhere, "new");
  EXPECT_EQ(text_of(nowhere), "new");
}

TEST(HostileOutputs, DevicesAreWrittenToAndNotReplaced) {
  write_file("/dev/null", "anything");
  struct stat now {};
  ASSERT_EQ(stat("/dev/null", &now), 0);
  EXPECT_TRUE(S_ISCHR(now.st_mode));
  LogWriter log("/dev/null", {"a"});
  log.write({1.0});
  log.close();
  ASSERT_EQ(stat("/dev/null", &now), 0);
  EXPECT_TRUE(S_ISCHR(now.st_mode));

  EXPECT_TRUE(says(refusal([] { write_file("/dev/full", "anything"); }), "cannot be written"));
  EXPECT_TRUE(says(refusal([] {
                     LogWriter full("/dev/full", {"a"});
                     full.close();
                   }),
                   "cannot be written"));
  ASSERT_EQ(stat("/dev/full", &now), 0);
  EXPECT_TRUE(S_ISCHR(now.st_mode));
}

TEST(HostileOutputs, FoldersAreNoFiles) {
  EXPECT_TRUE(says(refusal([] { write_file(scratch(), "anything"); }), "is a folder"));
  EXPECT_TRUE(
      says(refusal([] { write_file(scratch() + "/none/file", "anything"); }), "cannot be written"));
  EXPECT_TRUE(says(refusal([] { write_file("", "anything"); }), "cannot be "));
  EXPECT_TRUE(says(refusal([] { LogWriter(scratch(), {"a"}); }), "is a folder"));
}

// A set of files is written as a whole or not at all.
TEST(HostileOutputs, AFolderWhereOneOfASetWouldBe) {
  ASSERT_EQ(shapeid("simulate --exact --seconds 2 --rate 50 --out set.csv").status, 0);
  scratch_file("box.yaml", "base: [{kind: cuboid, size: [0.5, 0.25, 0.15]}]\n");
  const std::string robots = SHAPEID_SOURCE_DIR "/models/robots/";
  const std::string inputs = fmt::format(
      "--robot {0}quadruped.urdf --log set.csv --exact --shapes box.yaml --out set", robots);
  fs::create_directories(scratch() + "/set/identified.urdf");
  for (const std::string verb : {"identify ", "diagnose "}) {
    const CommandRun run = shapeid(verb + inputs);
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_TRUE(says(run.err, "identified.urdf: is a folder")) << run.err;
    EXPECT_EQ(std::distance(fs::directory_iterator(scratch() + "/set"), fs::directory_iterator()),
              1);
  }
}

// What a user types may hold anything as well.
TEST(HostileOutputs, ArgumentsInMessages) {
  expect_one_line(shapeid("inspect \"$(printf 'a\\nb.csv')\""), 2, "a\\x0ab.csv");
}

}  // namespace
}  // namespace shapeid::test
