// What is given to a verb and cannot be meant: numbers, values, files, readings. Each was once
// taken (or crashed, or never ended).
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "shapeid/models/log.hpp"
#include "shapeid/models/log_writer.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/tests/app/command.hpp"

namespace shapeid::test {
namespace {

/// One line that says so, exit status 2 (or another), nothing printed.
void expect_refused(const std::string& arguments, const std::string& says, int status = 2) {
  SCOPED_TRACE("shapeid " + arguments);
  const CommandRun run = shapeid(arguments);
  EXPECT_EQ(run.status, status) << run.err;
  EXPECT_NE(run.err.find(says), std::string::npos) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_TRUE(run.out.empty()) << run.out;
}

class Given : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { simulated_log("given.csv", "--seconds 2"); }

  /// The log with one number changed.
  static void write_with(const std::string& column, int line, double value) {
    change([&](const std::vector<std::string>& columns, LogRow& row) {
      if (row.line != line) return;
      const auto at = std::find(columns.begin(), columns.end(), column) - columns.begin();
      row.values[static_cast<std::size_t>(at)] = value;
    });
  }
  static void change(
      const std::function<void(const std::vector<std::string>&, LogRow&)>& change_row,
      const std::string& from = "given.csv", const std::string& to = "changed.csv") {
    LogReader log(scratch() + "/" + from);
    LogWriter out(scratch() + "/" + to, log.columns());
    while (std::optional<LogRow> row = log.next()) {
      change_row(log.columns(), *row);
      out.write(row->values);
    }
    out.close();
  }
};

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
  expect_refused("certify given.csv given.csv --gap nan", "--gap is not a finite number");
  expect_refused("simulate --out a.csv --seed -1", "--seed");
  expect_refused("simulate --out a.csv --seed 99999999999999999999", "--seed");
  expect_refused("simulate --out a.csv --load 1 1e308 0 0", "--load");
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
  expect_refused(words + "--hold-out 1.5", "--hold-out: Value 1.5 not in range 1 to 5");
  expect_refused(track + "--window 3.7", "--window is \"3.7\"; give a count, 0 or more");
  expect_refused(words + "--divisions many", "--divisions");
  expect_refused(words + "--divisions 1 --divisions 2", "--divisions is given twice; give it once");
  expect_refused(track + "--robot given.csv", "--robot is given twice; give it once");
}

/// A log with joints alone, of a robot with an IMU.
TEST_F(Given, ALogWithoutItsBase) {
  LogReader log(scratch() + "/given.csv");
  std::vector<std::size_t> kept;
  std::vector<std::string> names;
  for (std::size_t c = 0; c < log.columns().size(); ++c) {
    if (log.columns()[c].starts_with("base.")) continue;
    kept.push_back(c);
    names.push_back(log.columns()[c]);
  }
  LogWriter out(scratch() + "/joints.csv", names);
  while (const std::optional<LogRow> row = log.next()) {
    std::vector<double> values;
    for (const std::size_t c : kept) values.push_back(row->values[c]);
    out.write(values);
  }
  out.close();
  scratch_file("feet.yaml", "contacts: [{link: FR_foot}]\n");
  expect_refused(
      fmt::format("identify --robot {}quadruped.urdf --robot-yaml feet.yaml --log joints.csv",
                  robots),
      "the log has no base.* columns, though feet.yaml has contacts");
  scratch_file("imu.yaml", "imu: {xyz: [0, 0, 0.1], rpy: [0, 0, 1.57]}\n");
  const std::string robot = fmt::format("--robot {}quadruped.urdf --robot-yaml imu.yaml ", robots);
  expect_refused(fmt::format("identify {} --log joints.csv", robot),
                 "the log has no base.* columns, though imu.yaml has an IMU");
  const CommandRun run = shapeid(fmt::format("inspect joints.csv {}", robot));
  EXPECT_NE(run.out.find("the base is taken as fixed"), std::string::npos) << run.out << run.err;
}

/// What is found beside the robot changes the answer, so it is said.
TEST_F(Given, RobotYamlThatWasFoundIsSaid) {
  const std::string found = robots + "quadruped.robot.yaml";
  const std::string beside = found + " stands beside the URDF and is used";
  for (const std::string verb :
       {"identify --divisions 0", "load --area base 0 1 0 1 0 1 --divisions 0"}) {
    SCOPED_TRACE(verb);
    const std::string words =
        fmt::format("{} --robot {}quadruped.urdf --log given.csv ", verb, robots);
    const CommandRun text = shapeid(words);
    EXPECT_NE(text.out.find("note: " + beside), std::string::npos) << text.out << text.err;
    const CommandRun named = shapeid(words + "--robot-yaml " + found);
    EXPECT_EQ(named.out.find(beside), std::string::npos) << named.out;
    for (const char* option : {"", "--robot-yaml imu.yaml"}) {
      scratch_file("imu.yaml", "imu: {xyz: [0, 0, 0.1], rpy: [0, 0, 1.57]}\n");
      const CommandRun run = shapeid(words + "--json " + option);
      const std::string file = *option == '\0' ? found : "imu.yaml";
      EXPECT_NE(run.out.find(fmt::format("\"robot_yaml\": \"{}\"", file)), std::string::npos)
          << run.err;
    }
  }
  simulated_log("longer.csv", "--seconds 5 --seed 3");
  const CommandRun diagnosis =
      shapeid(fmt::format("diagnose --trust --robot {}quadruped.urdf --log longer.csv --test "
                          "given.csv --json",
                          robots));
  ASSERT_EQ(diagnosis.status, 0) << diagnosis.err;
  EXPECT_NE(diagnosis.out.find(beside), std::string::npos);
  EXPECT_NE(diagnosis.out.find(fmt::format("\"robot_yaml\": \"{}\"", found)), std::string::npos);
}

/// A log that ends within the stretch that is held out: its samples are good, but none is fitted.
TEST_F(Given, LogsOfWhichNothingIsFitted) {
  for (const char* verb : {"identify", "diagnose --trust"}) {
    expect_refused(fmt::format("{} {} --log given.csv --hold-out 1", verb, quadruped_files),
                   "held out for the test, or too near to what is; give --test", 1);
  }
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

/// A log that is slower than the usual filter is looked at with another.
TEST_F(Given, SlowLogsCanBeInspected) {
  LogReader log(scratch() + "/given.csv");
  LogWriter out(scratch() + "/slow.csv", log.columns());
  constexpr int every = 20;  // of 500 Hz
  for (int i = 0; std::optional<LogRow> row = log.next(); ++i) {
    if (i % every == 0) out.write(row->values);
  }
  out.close();
  const std::string inspect = fmt::format("inspect slow.csv {} ", quadruped_files);
  expect_refused(inspect, "choose a cutoff");
  const CommandRun seen = shapeid(inspect + "--cutoff 5");
  EXPECT_EQ(seen.status, 0) << seen.err;
  expect_refused("inspect slow.csv --cutoff 5", "--cutoff requires --robot");
}

TEST_F(Given, ColumnsWithoutANumberAreSaidToHaveNone) {
  scratch_file("empty.csv", "time,a,b\n0,,1\n1,,2\n");
  const CommandRun seen = shapeid("inspect empty.csv");
  EXPECT_EQ(seen.status, 0) << seen.err;
  EXPECT_EQ(seen.out.find("inf"), std::string::npos) << seen.out;
  EXPECT_NE(seen.out.find("no number        2\n"), std::string::npos) << seen.out;
}

/// What robot.yaml expects of a load scales the criterion, unless the command says otherwise.
TEST_F(Given, TheMassOfALoadThatIsExpected) {
  const std::string load = fmt::format(
      "load --robot {}quadruped.urdf --robot-yaml notes.yaml --log given.csv --area base -.2 .2 "
      "-.1 .1 .06 .1 --divisions 0 --json",
      robots);
  const std::string notes = read_small_file(robots + "quadruped.robot.yaml", 1 << 20);
  const auto found = [&](const std::string& expected, const std::string& option) {
    const std::size_t at = notes.find("  load: [0.0, 3.0]\n");
    EXPECT_NE(at, std::string::npos);
    std::string changed = notes;
    scratch_file("notes.yaml", changed.replace(at, changed.find('\n', at) + 1 - at, expected));
    const CommandRun run = shapeid(load + option);
    EXPECT_EQ(run.status, 0) << run.err;
    return run.out;
  };
  const std::string usual = found("", ""), heavy = found("  load: [2, 6]\n", "");
  EXPECT_EQ(heavy, found("", " --expected-mass 4"));
  EXPECT_EQ(usual, found("  load: [2, 6]\n", " --expected-mass 1"));
  EXPECT_NE(heavy, usual);
}

TEST_F(Given, ReadingsThatNoRobotHas) {
  const auto identified =
      fmt::format("identify {} --log changed.csv --divisions 0", quadruped_files);
  const std::vector<std::pair<std::string, double>> readings = {{"base.gyro.x", 1e80},
                                                                {"base.gyro.z", -2e3},
                                                                {"base.accel.y", 1e6},
                                                                {"tau.FR_knee", 1e10},
                                                                {"dq.RL_hip", -1e6}};
  for (const auto& [column, value] : readings) {
    write_with(column, 502, value);
    expect_refused(identified, fmt::format("changed.csv:502, column {}", column));
  }
  for (const double time : {1.7e18, 1e30, 2e5}) {
    write_with("time", 1001, time);
    expect_refused(identified, "changed.csv:1001, column time");
    expect_refused(fmt::format("inspect changed.csv {}", quadruped_files),
                   "changed.csv:1001, column time");
  }
  write_with("time", 2, -1.7e18);
  expect_refused(fmt::format("track {} changed.csv", quadruped_files),
                 "changed.csv:2, column time");
}

TEST_F(Given, LogsThatAskForNoMass) {
  const auto scaled_by = [](const std::string& prefix, double factor) {
    return [=](const std::vector<std::string>& columns, LogRow& row) {
      for (std::size_t c = 0; c < columns.size(); ++c) {
        if (columns[c].starts_with(prefix)) row.values[c] *= factor;
      }
    };
  };
  const auto identified =
      fmt::format("identify {} --log changed.csv --divisions 0", quadruped_files);
  change(scaled_by("base.accel.", -1.0));
  expect_refused(identified, "asks for no mass", 1);
  change(scaled_by("tau.", -1.0));
  expect_refused(identified, "asks for no mass", 1);
  simulated_log("other.csv", "--seconds 2 --seed 2");
  change(scaled_by("tau.", -1.0), "other.csv", "likewise.csv");
  expect_refused(
      fmt::format("batch {} --log changed.csv likewise.csv --divisions 0", quadruped_files),
      "asks for no mass", 1);
  change(scaled_by("tau.", 0.0));
  expect_refused(identified, "never changes while the joints move");
}

/// A mapping that says nothing of the base leaves the log's own names, and with them the base.
TEST_F(Given, AMappingNeedsNoEntryForOurOwnNames) {
  scratch_file("torque.yaml", "torque: {kind: joint}\n");
  const std::string plain =
      fmt::format("identify {} --log given.csv --divisions 0 --json", quadruped_files);
  const CommandRun mapped = shapeid(plain + " --mapping torque.yaml"), unmapped = shapeid(plain);
  ASSERT_EQ(mapped.status, 0) << mapped.err;
  EXPECT_EQ(mapped.out, unmapped.out);
}

TEST_F(Given, ARobotWithoutNotesSaysWhatIsTakenForGranted) {
  std::filesystem::create_directories(scratch() + "/alone");
  std::filesystem::copy_file(robots + "quadruped.urdf", scratch() + "/alone/dog.urdf",
                             std::filesystem::copy_options::overwrite_existing);
  const std::string words = "identify --robot alone/dog.urdf --divisions 0 --log ";
  // The bundled robot's IMU is turned by a quarter.
  expect_refused(words + "given.csv", "turn the IMU (robot.yaml: without it", 1);
  scratch_file("no_imu.yaml",
               "contacts: [{link: FR_foot}, {link: FL_foot}, {link: RR_foot}, {link: RL_foot}]\n");
  ASSERT_EQ(shapeid("simulate --seconds 3 --robot-yaml no_imu.yaml --out no_imu.csv").status, 0);
  EXPECT_NE(shapeid(words + "no_imu.csv").out.find("IMU is taken to be at the base's origin"),
            std::string::npos);
  std::filesystem::remove(scratch() + "/alone/dog.robot.yaml");
  std::filesystem::create_symlink("nowhere.yaml", scratch() + "/alone/dog.robot.yaml");
  expect_refused(words + "no_imu.csv", "dog.robot.yaml");
}

TEST_F(Given, EffectsBeyondTheirRange) {
  const auto expect_wrong = [](const std::string& entry, const std::string& says) {
    scratch_file("wrong.yaml", "effects:\n  - " + entry + "\n");
    expect_refused(fmt::format("identify {} --log given.csv --divisions 0 --effects wrong.yaml",
                               quadruped_files),
                   "wrong.yaml:2: " + says);
  };
  expect_wrong("{effect: torque_delay, site: all, values: {d: 0.05}}", "d is 0.05");
  expect_wrong("{effect: torque_delay, site: all, values: {d: -1e300}}", "d is -1e+300");
  expect_wrong("{effect: coulomb_friction, site: FR_knee, values: {width: 0.05, c: -0.6}}",
               "c is -0.6; at least 0");
  const auto friction = [](double width) {
    return fmt::format("{{effect: coulomb_friction, site: FR_knee, values: {{width: {}, c: 0.6}}}}",
                       width);
  };
  expect_wrong(friction(3.01), "width is 3.01; 0.0003 to 3 rad/s");
  expect_wrong(friction(0.00029), "width is 0.00029");
  for (const double known : {2.99, 0.00031}) {  // wider and narrower than what diagnose seeks
    scratch_file("known.yaml", "effects:\n  - " + friction(known) + "\n");
    EXPECT_EQ(shapeid(fmt::format("identify {} --log given.csv --divisions 0 --effects known.yaml",
                                  quadruped_files))
                  .status,
              0);
  }
  expect_wrong("{effect: rotor_inertia, site: FR_knee, values: {I: -1}}", "I is -1; at least 0");
  scratch_file("wrong.yaml", "effects: []\n---\neffects: []\n");
  expect_refused(fmt::format("identify {} --log given.csv --effects wrong.yaml", quadruped_files),
                 "wrong.yaml:2: a second document");
}

TEST_F(Given, NotesBeyondAnyRobot) {
  const auto expect_wrong = [](const std::string& notes, const std::string& says) {
    scratch_file("notes.yaml", notes + "\n");
    expect_refused(
        fmt::format("identify --robot {}quadruped.urdf --robot-yaml notes.yaml --log given.csv",
                    robots),
        says);
  };
  expect_wrong("imu: {xyz: [1e308, 1e308, 0]}", "notes.yaml:1: imu xyz");
  expect_wrong("contacts: [{link: FR_foot, point: [0, 0, 1e200]}]", "notes.yaml:1: point");
  expect_wrong("noise: {tau: 1e-155}", "the sigma of tau");
  expect_wrong("expected_mass: {base: [4, 1e308]}", "the mass of base");
}

TEST_F(Given, SeveralContactsWithOneForce) {
  simulated_log("forces.csv", "--seconds 1 --exact");
  scratch_file("twice.yaml",
               "contacts: [{link: FR_foot}, {link: FL_foot}, {link: RR_foot}, {link: RL_foot}, "
               "{link: FR_foot, point: [0.01, 0, 0]}]\n");
  expect_refused(fmt::format("identify --robot {}quadruped.urdf --robot-yaml twice.yaml --log "
                             "forces.csv --exact --contacts measured",
                             robots),
                 "FR_foot has several contacts");
}

/// Units are judged in logs with exact derivatives, too.
TEST_F(Given, ExactLogsInOtherUnits) {
  simulated_log("given.csv", "--seconds 2 --exact");
  change([&](const std::vector<std::string>& columns, LogRow& row) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (columns[c].starts_with("base.accel.")) row.values[c] /= 9.81;
    }
  });
  SetUpTestSuite();  // the log as it was, for the others
  expect_refused(fmt::format("identify {} --log changed.csv --exact", quadruped_files),
                 "looks like g");
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

TEST_F(Given, FactorsForJointsThatAreNotThere) {
  std::string factors = "torque: {kind: motor, factor: {nosuch: 3";
  for (const char* leg : {"FR", "FL", "RR", "RL"}) {
    for (const char* joint : {"abad", "hip", "knee"})
      factors += fmt::format(", {}_{}: 6", leg, joint);
  }
  scratch_file("factors.yaml", factors + "}}\n");
  expect_refused(fmt::format("identify {} --log given.csv --mapping factors.yaml", quadruped_files),
                 "nosuch");
}

/// Windows that are longer than the silence after which a line says that nothing comes.
TEST_F(Given, LongWindowsAreNoSilence) {
  const CommandRun run = shapeid(fmt::format("track {} given.csv --window 100", quadruped_files));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out.find("no samples"), std::string::npos);
  EXPECT_GT(std::count(run.out.begin(), run.out.end(), '\n'), 3);
}

/// Drives that are off for the first second: no window of zeros may spoil what follows.
TEST_F(Given, TrackingBeginsWithDrivesThatAreOff) {
  const std::string arm =
      "<robot name='arm'><link name='world'/><link name='bar'><inertial><origin xyz='0.1 0.02 "
      "-0.3'/>"
      "<mass value='1.5'/><inertia ixx='0.05' ixy='0.001' ixz='0.002' iyy='0.06' iyz='-0.003' "
      "izz='0.02'/></inertial><collision><origin xyz='0.1 0 -0.3'/><geometry><box "
      "size='0.2 0.1 0.5'/></geometry></collision></link><joint name='hinge' type='revolute'>"
      "<parent link='world'/><child link='bar'/><axis xyz='0 1 0'/><limit lower='-3' upper='3' "
      "effort='50' velocity='20'/></joint></robot>";
  scratch_file("off.urdf", arm);
  std::string log = "time,q.hinge,tau.hinge\n";
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.002 * i, q = std::sin(3.0 * t), ddq = -9.0 * q;
    const double gravity = 9.81 * 1.5 * (0.1 * std::cos(q) - 0.3 * std::sin(q));
    const double tau = i < 600 ? 0.0 : 0.21 * ddq - gravity + 0.001 * std::sin(977.0 * t);
    log += fmt::format("{},{},{}\n", t, q, tau);
  }
  scratch_file("off.csv", log);
  const CommandRun run = shapeid("track --robot off.urdf off.csv --whole-body");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out.find("[0.0,null]"), std::string::npos);
  EXPECT_EQ(run.out.find("NaN"), std::string::npos);
  EXPECT_NE(run.out.find("\"answered\":true"), std::string::npos);
}

/// A name is any bytes; JSON is not.
TEST_F(Given, LogsWithNamesThatAreNoText) {
  const std::string name = "given\xfe.csv";
  scratch_file(name, read_small_file(simulated_log("other.csv", "--seconds 2 --seed 2"), 1 << 26));
  EXPECT_EQ(shapeid("inspect --json '" + name + "'").status, 0);
  EXPECT_EQ(
      shapeid(fmt::format("identify {} --log '{}' --divisions 0 --json", quadruped_files, name))
          .status,
      0);
  const CommandRun batch =
      shapeid(fmt::format("batch {} --log given.csv '{}' '{}' --skip-refused --divisions 0 --json",
                          quadruped_files, name, "none\xfe.csv"));
  EXPECT_EQ(batch.status, 0) << batch.err;
  EXPECT_EQ(shapeid("simulate --seconds 0.2 --json --out 'new\xfe.csv'").status, 0);
}

/// What is not whole when a user loses patience is not left behind.
TEST_F(Given, AnInterruptLeavesNoHalfOfAFile) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
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
