// The command on inputs that would take all memory, or that recurse: one line, exit status 2 or 1.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/hostile/refused.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

TEST(HostileCommand, CertifyDeepAnswers) {
  scratch_file("deep.json", repeated("[", 1000000));
  expect_one_line(shapeid("certify deep.json deep.json"), 2, "nested deeper than 64");
}

// A foreign program may print what it likes.
TEST(HostileCommand, VectorsOfAProgramThatMeansHarm) {
  scratch_file("deep.txt", repeated("{\"v\":", 500000) + "\n");
  const CommandRun deep =
      shapeid("vectors --kind existence --check \"while read x; do cat deep.txt; done\"");
  EXPECT_EQ(deep.status, 1) << deep.err;
  expect_one_line(shapeid("vectors --kind existence --check \"tr '\\\\0' x </dev/zero\""), 2,
                  "endless line");
}

TEST(HostileCommand, VectorsOfAFolderThatMeansHarm) {
  const std::string head =
      "{\"format\":\"shapeid-vectors-1\",\"made_by\":\"x\",\"flags\":{},\"files\":";
  std::filesystem::create_directories(scratch() + "/bad");
  scratch_file("bad/index.json", head + "{\"../../etc/passwd\":\"0\"}}");
  expect_one_line(shapeid("vectors --check cat --vectors bad"), 2, "leads out of the folder");
  scratch_file("bad/index.json", head + "[1,2]}");
  expect_one_line(shapeid("vectors --check cat --vectors bad"), 2, "bad/");
}

/// What is opened must not become standard input, output or error because these were closed.
TEST(HostileCommand, StandardDescriptorsThatAreClosed) {
  const std::string check = command("vectors --kind moments --check 'cat'");
  const CommandRun open = program(in_bash(check + " >/dev/null"));
  EXPECT_EQ(open.status, 1) << open.err;
  for (const std::string closed : {"<&-", "2>&-", "<&- 2>&-"}) {
    EXPECT_EQ(program(in_bash(fmt::format("{} {} >/dev/null", check, closed))).status, 1) << closed;
  }
  const CommandRun mute =
      program(in_bash(command("simulate --seconds 0.2 --out quiet.csv") + " >&-"));
  EXPECT_EQ(mute.status, 2);
  EXPECT_NE(mute.err.find("standard output"), std::string::npos) << mute.err;
}

TEST(HostileCommand, AFileThatMayNotGrow) {
  const CommandRun run = program(
      in_bash(fmt::format("ulimit -f 4; {}", command("simulate --seconds 0.5 --out large.csv"))));
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("large.csv: cannot be written"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(scratch() + "/large.csv"));
}

TEST(HostileCommand, ANameThatLeavesNoRoomForAnother) {
  const std::string name = std::string(248, 'r') + ".urdf";
  std::filesystem::copy_file(robots + "quadruped.urdf", scratch() + "/" + name);
  simulated_log("trot.csv", "--seconds 1");
  EXPECT_EQ(shapeid(fmt::format("inspect trot.csv --robot {}", name)).status, 0);
}

TEST(HostileCommand, CheckpointsThatAreDamaged) {
  const std::string robots = SHAPEID_SOURCE_DIR "/models/robots/quadruped";
  const std::string track = fmt::format(
      "track --robot {0}.urdf --shapes {0}.shapes.yaml --checkpoint state.json", robots);
  simulated_log("trot.csv", "--seconds 1");
  ASSERT_EQ(shapeid(track + " trot.csv").status, 0);
  const std::string good = text_of(scratch() + "/state.json");
  const auto expect_refused = [&](const std::string& text, const std::string& words) {
    scratch_file("state.json", text);
    expect_one_line(shapeid(track + " --resume trot.csv"), 2, words);
  };
  nlohmann::json changed = nlohmann::json::parse(good);
  changed["state"]["calm"] = 7;
  expect_refused(changed.dump(), "is damaged");
  expect_refused(good.substr(0, good.size() / 2), "is not JSON");
  expect_refused(repeated("[", 1000000), "nested deeper than 64");
  expect_refused("", "is not JSON");
  expect_refused("{\"format\":\"shapeid-checkpoint-10\"}", "is no whole checkpoint");
}

}  // namespace
}  // namespace shapeid::test
