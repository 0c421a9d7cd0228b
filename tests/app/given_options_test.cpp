// Options that cannot be meant: numbers, counts, files that are given twice or would be lost.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include "shapeid/models/text.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/app/given.hpp"

namespace shapeid::test {
namespace {

TEST_F(Given, NumbersThatAreNoneOrBeyondAnyRobot) {
  const std::string identify = fmt::format("identify {} --log given.csv ", quadruped_files);
  for (const char* rate : {"0", "-5", "nan", "inf", "1e9", "0x100"}) {
    expect_refused(identify + "--rate " + rate, "--rate");
    expect_refused(fmt::format("track {} given.csv --rate {}", quadruped_files, rate), "--rate");
  }
  for (const char* mass : {"1e307", "1e-200", "nan"}) {
    expect_refused(identify + "--expected-mass " + mass, "--expected-mass");
    expect_refused(fmt::format("track {} given.csv --expected-mass {}", quadruped_files, mass),
                   "--expected-mass");
  }
  expect_refused(identify + "--k1 0 --k2 0", "both 0");
  expect_refused(identify + "--online --alpha 0", "--alpha");
  expect_refused(identify + "--contact-threshold 5", "at most 1");
  expect_refused(identify + "--contact-threshold nan", "nan");
  expect_refused(fmt::format("track {} given.csv --recent 1e9", quadruped_files), "--recent");
  expect_refused("certify given.csv given.csv --gap nan", "--gap: is not a finite number");
  expect_refused("simulate --out a.csv --seed -1", "--seed");
  expect_refused("simulate --out a.csv --seed 99999999999999999999", "--seed");
  expect_refused("simulate --out a.csv --load 1 1e308 0 0", "--load");
  expect_refused("simulate --out a.csv --load 1 0 50 0",
                 "--load: the block is 50 m from the link's origin, on a robot of");
  expect_refused("simulate --out a.csv --load 1 0 0 0 --load-from nan", "--load-from");
  expect_refused("simulate --out a.csv --load 1 0 0 0 --load-from 20", "never there");
  expect_refused("simulate --out a.csv --load 1 0 0 0 --load-from 2 --load-until 1", "never there");
  expect_refused("convert --from pinocchio --to mujoco 1e-300 1e300 1 .6 1 .1 1.2 .2 .3 1.4",
                 "do not fit into a double");
}

TEST_F(Given, ValuesThatAreEmptyAndOptionsThatWouldDoNothing) {
  const std::string identify = fmt::format("identify {} --log given.csv ", quadruped_files);
  for (const char* option : {"--out", "--test", "--effects", "--shapes", "--mapping"}) {
    expect_refused(fmt::format("{} {} ''", identify, option), fmt::format("{} is empty", option));
  }
  for (const char* other : {"--out o", "--test given.csv", "--effects none.yaml", "--min-mass 1",
                            "--row-cutoff 5", "--hold-out 1", "--k1 2", "--json"}) {
    expect_refused(fmt::format("{} --online {}", identify, other), "excludes");
  }
  for (const char* other : {"--window 5", "--stride 5", "--alpha 0.5"}) {
    expect_refused(identify + other, "requires --online");
  }
  expect_refused(identify + "--exact --cutoff 20", "excludes");
  expect_refused(identify + "--exact --rate 500", "excludes");
  for (const char* verb : {"identify --log", "diagnose --log", "track"}) {
    expect_refused(fmt::format("{} given.csv {} --contacts none --contact-threshold 0.2", verb,
                               quadruped_files),
                   "no contacts are derived");
  }
  expect_refused(fmt::format("track {} given.csv --patience 5", quadruped_files),
                 "requires --follow");
  expect_refused("simulate --out a.csv --load-from 1", "requires --load");
  expect_refused("simulate --out a.txt", "no name of a log");
  expect_refused("inspect given.csv --mapping none.yaml", "requires --robot");
  expect_refused(fmt::format("inspect {0}quadruped.urdf --robot none", robots), "a robot itself");
  expect_refused(fmt::format("diagnose {} --log given.csv --row-cutoff 5", quadruped_files),
                 "--row-cutoff");
  expect_refused("identfy", "there is no verb \"identfy\"");
}

TEST_F(Given, LogsThatAreGivenTwiceOrFlowBy) {
  expect_refused(fmt::format("batch {} --log given.csv ./given.csv", quadruped_files),
                 "given twice");
  expect_refused(fmt::format("identify {} --log -", quadruped_files), "is a stream");
  expect_refused(fmt::format("inspect - {}", quadruped_files), "is a stream");
}

TEST_F(Given, FilesThatAreReadAreNotWrittenOver) {
  const auto copied = [](const std::string& from, const std::string& name) {
    std::filesystem::create_directories(scratch() + "/own");
    std::filesystem::copy_file(from, scratch() + "/own/" + name,
                               std::filesystem::copy_options::overwrite_existing);
  };
  copied(robots + "quadruped.urdf", "identified.urdf");
  copied(robots + "quadruped.robot.yaml", "identified.robot.yaml");
  copied(scratch() + "/given.csv", "log.csv");
  const std::string own = "own/identified.urdf",
                    before = read_small_file(scratch() + "/" + own, 1 << 20);
  expect_refused(fmt::format("identify --robot {} --log given.csv --divisions 0 --out own", own),
                 "would be written over by --out");
  expect_refused(fmt::format("simulate --robot {0} --robot-yaml own/identified.robot.yaml "
                             "--out own/../own/identified.robot.yaml",
                             own),
                 "would be written over by --out");
  expect_refused(fmt::format("track {} own/log.csv --checkpoint own/log.csv", quadruped_files),
                 "would be written over by --checkpoint");
  expect_refused(fmt::format("track --robot {0} own/log.csv --checkpoint {0}", own),
                 "would be written over by --checkpoint");
  EXPECT_EQ(read_small_file(scratch() + "/" + own, 1 << 20), before);
  // What is beside the robot is read without being named.
  const std::string notes = read_small_file(scratch() + "/own/identified.robot.yaml", 1 << 20);
  const std::string beside =
      fmt::format("track --robot {} own/log.csv --checkpoint own/identified.robot.yaml", own);
  expect_refused(beside, "own/identified.robot.yaml: is no checkpoint");
  expect_refused(beside + " --resume", "own/identified.robot.yaml: is not JSON");
  EXPECT_EQ(read_small_file(scratch() + "/own/identified.robot.yaml", 1 << 20), notes);
  // One of an earlier run is replaced, of whichever version.
  scratch_file("own/state.json", "{\"format\": \"shapeid-checkpoint-1\"}\n");
  const std::string tracked =
      fmt::format("track --robot {} own/log.csv --checkpoint own/state.json", own);
  EXPECT_EQ(shapeid(tracked).status, 0);
  EXPECT_EQ(shapeid(tracked).status, 0);
  // identify writes no effects.
  scratch_file("own/effects.yaml", "effects: []\n");
  EXPECT_EQ(shapeid(fmt::format("identify {} --log own/log.csv --divisions 0 --effects "
                                "own/effects.yaml --out own",
                                quadruped_files))
                .status,
            0);
  // A folder with other files of the user's in it is a place like any other.
  EXPECT_EQ(
      shapeid(fmt::format("identify {} --log own/log.csv --divisions 0 --out own", quadruped_files))
          .status,
      0);
}

/// Numbers as people and programs write them, where CLI11 would see an option.
TEST_F(Given, NumbersWithoutALeadingDigitOrWithAPlus) {
  const CommandRun plain =
      shapeid("convert --from pinocchio --to drake 2 -0.2 0.4 0.6 1 0.1 1.2 -0.2 0.3 1.4");
  const CommandRun terse =
      shapeid("convert --from pinocchio --to drake +2 -.2 +0.4 .6 1 +.1 1.2 -.2 .3 1.4");
  EXPECT_EQ(terse.status, 0) << terse.err;
  EXPECT_EQ(terse.out, plain.out);
  expect_refused("convert --from pinocchio --to drake +-2 0 0 0 1 0 1 0 0 1", "+-2");
}

/// An option that no log can make right is no log's fault.
TEST_F(Given, ABatchOfWrongOptionsBlamesNoLog) {
  simulated_log("other.csv", "--seconds 2 --seed 2");
  const std::string batch = fmt::format("batch {} --log given.csv other.csv ", quadruped_files);
  expect_refused(batch + "--k1 0 --k2 0", "both 0");
  scratch_file("twice.yaml", "contacts: [{link: FR_foot}, {link: FR_foot, point: [0.01, 0, 0]}]\n");
  expect_refused(fmt::format("batch --robot {}quadruped.urdf --robot-yaml twice.yaml --log "
                             "given.csv other.csv --contacts measured",
                             robots),
                 "FR_foot has several contacts");
}

/// CLI11 would read 010 as eight.
TEST_F(Given, CountsWithLeadingZeros) {
  const std::string words = fmt::format("identify {} --log given.csv ", quadruped_files);
  expect_refused(words + "--divisions 012", "--divisions is \"012\"");
  expect_refused(words + "--online --window 010", "--window is \"010\"");
  expect_refused("simulate --seconds 1 --seed 0123 --out no.csv", "--seed is \"0123\"");
  EXPECT_EQ(shapeid(words + "--divisions 0").status, 0);
}

/// What is right is said, not only what is wrong.
TEST_F(Given, CountsThatAreNone) {
  const std::string words = fmt::format("identify {} --log given.csv ", quadruped_files);
  const std::string track = fmt::format("track {} given.csv ", quadruped_files);
  expect_refused(words + "--hold-out 0x1",
                 "--hold-out is \"0x1\", which is no decimal number; give a decimal count");
  expect_refused(words + "--hold-out 1.5",
                 "--hold-out: is \"1.5\"; must be a whole number from 1 to 5");
  expect_refused(track + "--window 3.7",
                 "--window: is \"3.7\"; must be a whole number from 1 to 1000000000");
  expect_refused(words + "--divisions many", "--divisions");
  expect_refused(words + "--divisions 1 --divisions 2", "--divisions is given twice; give it once");
  expect_refused(track + "--robot given.csv", "--robot is given twice; give it once");
}

/// Every number among the options, of every verb: what was given, and what is right.
TEST_F(Given, NumbersThatAreNoneNameTheirOption) {
  struct Numbers {
    std::string words, options, right;
    bool is_count;
  };
  const std::string identify = fmt::format("identify {} --log given.csv ", quadruped_files);
  const std::string batch = fmt::format("batch {} --log given.csv ", quadruped_files);
  const std::string diagnose = fmt::format("diagnose {} --log given.csv ", quadruped_files);
  const std::string track = fmt::format("track {} given.csv ", quadruped_files);
  const Numbers table[] = {
      {identify, "--hold-out", "a whole number from 1 to 5", true},
      {identify, "--divisions", "a whole number from 0 to 2147483647", true},
      {identify + "--online ", "--window", "a whole number from 1 to 1000000000", true},
      {identify + "--online ", "--stride", "a whole number from 1 to 1000000000", true},
      {identify, "--cutoff", "at least 0", false},
      {identify, "--row-cutoff", "above 0", false},
      {identify, "--rate", "from 1 to 20000 Hz", false},
      {identify, "--lambda", "at least 0", false},
      {identify, "--min-mass", "at least 0", false},
      {identify, "--expected-mass", "from 1e-6 to 1e6 kg", false},
      {batch, "--threads", "a whole number, 1 or more", true},
      {batch, "--blocks", "a whole number from 2 to 64", true},
      {diagnose, "--threads", "a whole number, 1 or more", true},
      {diagnose, "--least-t", "above 0", false},
      {track, "--window", "a whole number from 1 to 1000000000", true},
      {track, "--recent", "from 0.001 to 3600 s", false},
      {track, "--wander", "at least 0", false},
      {track + "--checkpoint c.json ", "--checkpoint-every", "a whole number, 1 or more", true},
      {"certify p.json a.json ", "--gap", "from 0 to 1", false},
      {"simulate --out s.csv ", "--seconds", "from 0.1 to 3600 s", false},
      {"simulate --out s.csv ", "--rate", "from 50 to 5000 Hz", false},
      {"simulate --out s.csv ", "--seed", "a whole number, 0 or more", true},
      {"vectors --check true ", "--shown", "a whole number, 0 or more", true},
  };
  for (const Numbers& n : table) {
    const auto expect_says = [&](const std::string& value, const std::string& wrong) {
      expect_refused(fmt::format("{}{} '{}'", n.words, n.options, value),
                     fmt::format("shapeid: {}: {}; must be {}\n", n.options, wrong, n.right));
    };
    expect_says("", "is empty");
    if (n.is_count) {
      for (const char* value : {"-1", "nan", "inf", "1e400", "2.5", "many"}) {
        expect_says(value, fmt::format("is \"{}\"", value));
      }
      expect_says("99999999999999999999", "is \"99999999999999999999\", which is too large");
    } else {
      expect_says("-1", "is -1");
      expect_says("nan", "is not a finite number (\"nan\")");
      expect_says("inf", "is not a finite number (\"inf\")");
      expect_says("1e400", "does not fit into a double (\"1e400\")");
      expect_says("many", "is not a number (\"many\")");
    }
  }
  expect_refused(identify + "--rate 2.5",
                 "--rate 2.5: a grid of 2.5 Hz for a log of 500 Hz; leave the log's rate");
  expect_refused(identify + "--divisions 3000000000",
                 "--divisions: is \"3000000000\"; must be a whole number from 0 to 2147483647");
}

/// So do lists of numbers, of which some are missing or cannot be.
TEST_F(Given, ListsOfNumbersSayWhichTheyAre) {
  const std::string load = fmt::format("load {} --log given.csv --area base ", quadruped_files);
  expect_refused(load + "0 1 0 1 0", "; LINK x0 x1 y0 y1 z0 z1: where the load may be, m");
  expect_refused("simulate --out s.csv --load 1 0 0", "; MASS X Y Z [SIDE]: a block");
  expect_refused("simulate --out s.csv --load 0 0 0 0.1",
                 "--load 0 0 0 0.1: no block that a robot");
  expect_refused("simulate --out s.csv --seconds 1 --load 1 0 0 0.1 --load-from 2.5",
                 "--load-from 2.5: the block is never there; a moment before --load-until and "
                 "before the end of the log, 1 s");
  expect_refused("simulate --out", "; log to write, .csv or .csv.gz");
}

/// Options that would do nothing beside each other.
TEST_F(Given, DiagnoseOptionsThatWouldDoNothing) {
  const std::string words = fmt::format("diagnose {} --log given.csv ", quadruped_files);
  expect_refused(words + "--curves", "--curves requires --out");
  expect_refused(words + "--trust --expected-mass 5", "--trust");
}

/// A log is read more than once, wherever it is given.
TEST_F(Given, StreamsAreNoLogs) {
  const CommandRun pipe = program("mkfifo flow.csv");
  ASSERT_EQ(pipe.status, 0) << pipe.err;
  for (const std::string& words :
       {fmt::format("identify {} --log given.csv --test flow.csv", quadruped_files),
        fmt::format("diagnose {} --log given.csv --also flow.csv", quadruped_files),
        fmt::format("diagnose {} --log given.csv --test flow.csv", quadruped_files),
        fmt::format("diagnose {} --log given.csv --reference flow.csv", quadruped_files),
        fmt::format("batch {} --log given.csv flow.csv", quadruped_files)}) {
    expect_refused(words, "flow.csv: is a stream");
  }
}

/// The expected mass scales a criterion: a bad guess must not make the tool reject its own answer.
TEST_F(Given, AMassThatWasExpectedWrongly) {
  ASSERT_EQ(shapeid(fmt::format(
                        "identify {} --log given.csv --expected-mass 0.3 --divisions 2 --out light",
                        quadruped_files))
                .status,
            0);
  const CommandRun certified =
      shapeid("certify light/problem.json light/answer.json --certificate light/certificate.json");
  EXPECT_EQ(certified.status, 0) << certified.err;
}

/// Windows that are longer than the silence after which a line says that nothing comes.
TEST_F(Given, LongWindowsAreNoSilence) {
  const CommandRun run = shapeid(fmt::format("track {} given.csv --window 100", quadruped_files));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out.find("no samples"), std::string::npos);
  EXPECT_GT(std::count(run.out.begin(), run.out.end(), '\n'), 3);
}

/// What is not whole when a user loses patience is not left behind.
TEST_F(Given, AnInterruptLeavesNoHalfOfAFile) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGINT, SIG_DFL);  // who runs the tests in the background ignores it
    const std::string out = scratch() + "/cut.csv";
    execl(SHAPEID_BUILD_DIR "/shapeid", "shapeid", "simulate", "--seconds", "600", "--out",
          out.c_str(), nullptr);
    _exit(127);
  }
  const std::string part = fmt::format("{}/cut.csv.part{}", scratch(), child);
  constexpr int tries = 1000;
  for (int i = 0; i < tries && !std::filesystem::exists(part); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(std::filesystem::exists(part)) << "it was being written";
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT);
  EXPECT_FALSE(std::filesystem::exists(part));
  EXPECT_FALSE(std::filesystem::exists(scratch() + "/cut.csv"));
}

}  // namespace
}  // namespace shapeid::test
