// What stands beside robot and log: robot.yaml, mapping, effects.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>

#include "shapeid/models/text.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/app/given.hpp"

namespace shapeid::test {
namespace {

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
  const std::string usual = found("", ""), heavy = found("  load: [0, 8]\n", "");
  EXPECT_EQ(heavy, found("", " --expected-mass 4"));
  EXPECT_EQ(usual, found("  load: [0, 8]\n", " --expected-mass 1"));
  EXPECT_NE(heavy, usual);
  // It bounds nothing, and says so.
  const std::string said = "notes.yaml expects a load of 2 to 6 kg";
  EXPECT_EQ(heavy.find(said), std::string::npos);
  EXPECT_NE(found("  load: [2, 6]\n", "").find(said), std::string::npos);
}

/// Of a link that is known it would do nothing: its given mass counts.
TEST_F(Given, TheMassThatIsExpectedOfALinkThatIsNotSought) {
  const std::string notes = read_small_file(robots + "quadruped.robot.yaml", 1 << 20);
  const std::size_t at = notes.find("  base: [4.0, 8.0]\n");
  ASSERT_NE(at, std::string::npos);
  std::string changed = notes;
  scratch_file("thigh.yaml", changed.insert(at, "  FR_thigh: [0.1, 3]\n  RL_thigh: [0.2, 3]\n"));
  const std::string given =
      fmt::format(" --robot {}quadruped.urdf --robot-yaml thigh.yaml ", robots);
  const std::string says =
      "thigh.yaml: expected_mass counts for links that are sought; these are not, and have their "
      "given mass: FR_thigh, RL_thigh\n";
  const CommandRun base = shapeid("identify --divisions 0 --log given.csv" + given);
  EXPECT_NE(base.out.find("note: " + says), std::string::npos) << base.out << base.err;
  const CommandRun tracked = shapeid("track given.csv" + given);
  EXPECT_NE(tracked.err.find("warning: " + says), std::string::npos) << tracked.err;
  const CommandRun thighs =
      shapeid("identify --divisions 0 --log given.csv --free FR_thigh RL_thigh base" + given);
  EXPECT_EQ((thighs.out + thighs.err).find("expected_mass counts"), std::string::npos);
  simulated_log("longer.csv", "--seconds 5 --seed 3");
  const CommandRun diagnosis =
      shapeid("diagnose --trust --log longer.csv --test given.csv" + given);
  ASSERT_EQ(diagnosis.status, 0) << diagnosis.err;
  EXPECT_NE(diagnosis.out.find("given mass: base, FR_thigh, RL_thigh"), std::string::npos)
      << diagnosis.out;
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

/// A sole may press anywhere: at its frame's origin there is a moment besides, which is not logged.
TEST_F(Given, AMeasuredForceOfALineOrAPlane) {
  simulated_log("forces.csv", "--seconds 1 --exact");
  for (const auto& [kind, says] : {std::pair("kind: plane, point: [0.05, 0, 0]", "of a plane"),
                                   std::pair("kind: line, axis: [0, 1, 0]", "of a line")}) {
    scratch_file("sole.yaml",
                 fmt::format("contacts: [{{link: FR_foot}}, {{link: FL_foot}}, {{link: RR_foot}}, "
                             "{{link: RL_foot, {}}}]\n",
                             kind));
    const std::string words = fmt::format(
        "identify --robot {}quadruped.urdf --robot-yaml sole.yaml --log forces.csv "
        "--exact --divisions 0 --contacts ",
        robots);
    expect_refused(words + "measured", std::string("RL_foot is the contact ") + says);
    EXPECT_EQ(shapeid(words + "auto").status, 0);
  }
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

}  // namespace
}  // namespace shapeid::test
