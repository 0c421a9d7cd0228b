// Bad input of every kind: one clear line, exit status 2 (or 1 where the answer is no), no file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "shapeid/tests/app/changed_log.hpp"
#include "shapeid/tests/app/command.hpp"

namespace shapeid::test {
namespace {

constexpr const char* pendulum = R"(<robot name="pendulum">
  <link name="world"/>
  <link name="arm">
    <inertial><origin xyz="0.1 0.02 -0.3"/><mass value="1.5"/>
      <inertia ixx="0.05" ixy="0.001" ixz="0.002" iyy="0.06" iyz="-0.003" izz="0.02"/></inertial>
    <collision><origin xyz="0.1 0 -0.3"/><geometry><box size="0.2 0.1 0.5"/></geometry></collision>
  </link>
  <joint name="hinge" type="revolute"><parent link="world"/><child link="arm"/>
    <axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="50" velocity="20"/></joint>
</robot>
)";

std::string still_log() {
  std::string text = "time,q.hinge,tau.hinge\n";
  for (int i = 0; i < 2000; ++i) text += fmt::format("{},0.0,0.0\n", 0.002 * i);
  return text;
}

/// A weight that is held still: rounding of its accelerations is no motion.
std::string held_log() {
  std::string text = "time,q.hinge,tau.hinge\n";
  for (int i = 0; i < 2000; ++i) text += fmt::format("{},0.5,1.2\n", 0.002 * i);
  return text;
}

struct Refused {
  std::string arguments;
  int status;
  std::string says;
};

TEST(Refusals, OneLineThatSaysWhatIsWrongAndWhatWouldBeRight) {
  const std::string robot = scratch_file("pendulum.urdf", pendulum);
  const std::string log = scratch_file("still.csv", still_log());
  const std::string held = scratch_file("held.csv", held_log());
  const std::string no_robot = scratch_file("broken.urdf", "<robot name='x'><link name='a'>");
  const std::string empty = scratch_file("empty.csv", "");
  const std::string letters = scratch_file("letters.csv", "time,q.hinge,tau.hinge\n0,1,x\n");
  const std::vector<Refused> table = {
      {"", 2, "subcommand is required"},
      {"frobnicate", 2, "there is no verb \"frobnicate\""},
      {"identify", 2, "--robot is required"},
      {"identify --robt r.urdf --log l.csv", 2,
       "identify has no option --robt; see shapeid identify --help"},
      {"track --robot=r.urdf --cutof=3 l.csv", 2, "track has no option --cutof"},
      {"identify --robot missing.urdf --log " + log, 2, "missing.urdf"},
      {fmt::format("identify --robot {} --log missing.csv", robot), 2, "missing.csv"},
      {fmt::format("identify --robot {} --log {} --free arm", no_robot, log), 2, "broken.urdf"},
      {fmt::format("identify --robot {} --log {} --free arm", robot, empty), 2, "empty.csv"},
      {fmt::format("identify --robot {} --log {} --free arm", robot, letters), 2, "letters.csv:2"},
      {fmt::format("identify --robot {} --log {}", robot, log), 2, "--whole-body"},
      {fmt::format("identify --robot {} --log {} --free leg", robot, log), 2, "no such link"},
      {fmt::format("identify --robot {} --log {} --free arm", robot, held), 1, "nothing moves"},
      {fmt::format("load --robot {} --log {} --area arm 0 0.1 0 0.1 -0.5 0", robot, held), 1,
       "nothing moves"},
      {fmt::format("identify --robot {} --log {} --free arm --lambda -1", robot, log), 2,
       "--lambda: is -1; must be at least 0"},
      {fmt::format("identify --robot {} --log {} --free arm --lambda nan", robot, log), 2,
       "--lambda: is not a finite number (\"nan\"); must be at least 0"},
      {fmt::format("identify --robot {} --log {} --free arm --divisions x", robot, log), 2,
       "divisions"},
      {fmt::format("identify --robot {} --log {} --free arm --k1 1e308", robot, log), 2,
       "--k1: is 1e308; must be from 0 to 1e100"},
      {fmt::format("identify --robot {} --log {} --free arm --k1 0 --k2 0", robot, log), 2,
       "--k1 and --k2 are both 0"},
      {fmt::format("track --robot {} {} --free arm --contacts measured", robot, log), 2,
       "there are no force.* columns"},
      {fmt::format("load --robot {} --log {} --area arm 0 1 0 1 1 0", robot, log), 2, "empty"},
      {fmt::format("load --robot {} --log {} --area arm 0 1 0 1 0 nan", robot, log), 2, "nan"},
      {fmt::format("load --robot {} --log {} --area arm 0 90 0 90 -300 0", robot, log), 2,
       "--area: a corner is 326 m from the link's origin, on a robot of"},
      {fmt::format("load --robot {} --log {} --area leg 0 1 0 1 0 1", robot, log), 2, "leg"},
      {"convert --from pinocchio --to nonsense 1 2 3", 2, "nonsense"},
      {"convert --from pinocchio --to drake 1 2 3", 2, "10"},
      {"convert --from pinocchio --to drake 1 0 0 0 1 0 1 0 0 1e999", 2, "1e999"},
      {"simulate --out missing_folder/log.csv --seconds 0.2", 2, "missing_folder"},
      {"simulate --out log.csv --load 1 2", 2, "--load"},
      {"simulate --out log.csv --load -1 0 0 0.08", 2, "mass and side above 0"},
      {"inspect missing.csv", 2, "missing.csv"},
      {"inspect " + no_robot, 2, "broken.urdf"},
  };
  for (const Refused& r : table) {
    SCOPED_TRACE("shapeid " + r.arguments);
    const CommandRun run = shapeid(r.arguments);
    EXPECT_EQ(run.status, r.status) << run.err;
    EXPECT_NE(run.err.find(r.says), std::string::npos) << run.err;
    EXPECT_EQ(lines_said(run), 1) << run.err;
    EXPECT_TRUE(run.out.empty()) << run.out;
  }
}

// A turntable at rest: its axis is vertical, so gravity never reaches the joint either.
TEST(Refusals, DataThatCannotAnswerAreRefusedWithTheirReason) {
  std::string turntable = pendulum;
  turntable.replace(turntable.find("0 1 0"), 5, "0 0 1");
  const std::string robot = scratch_file("turntable.urdf", turntable);
  const std::string log = scratch_file("still.csv", still_log());
  const CommandRun run =
      shapeid(fmt::format("identify --robot {} --log {} --free arm --out answers", robot, log));
  EXPECT_EQ(run.status, 1) << run.err;
  EXPECT_NE(run.err.find("not-excited"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(scratch() + "/answers"));

  const CommandRun online = shapeid(
      fmt::format("identify --robot {} --log {} --free arm --online --window 100000", robot, log));
  EXPECT_EQ(online.status, 1) << online.err;
  EXPECT_NE(online.err.find("too-short"), std::string::npos) << online.err;
}

/// Where the samples went that are not there.
TEST(Refusals, ALogOfWhichNothingIsLeftSaysWhy) {
  simulated_log("run.csv", "--seconds 2");
  const auto unknown = [](NamedRow& row) {
    row.each("contact.", [](double& flag) { flag = -1.0; });
  };
  write_changed("run.csv", "unknown.csv", unknown);
  const std::string says = "samples left out near changes of contact, or because no flag";
  for (const std::string verb :
       {"identify", "load --area base -0.2 0.2 -0.1 0.1 0.05 0.09", "diagnose"}) {
    expect_one_line(shapeid(fmt::format("{} {} --log unknown.csv", verb, quadruped_files)), 1,
                    says);
  }
  // Shorter than a filter of 0.5 Hz reaches.
  expect_one_line(shapeid(fmt::format("identify {} --log run.csv --cutoff 0.5", quadruped_files)),
                  1, "samples lost to the filter at the ends");
}

// A block of 80 kg, a hand's breadth in front of the middle of a robot of 13 kg.
TEST(Refusals, ARobotThatFellLeavesNoLog) {
  const CommandRun run = shapeid("simulate --out fell.csv --seconds 3 --load 80 0.1 0 0.1");
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.err.find("refused (fell): the robot fell after 0."), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(scratch() + "/fell.csv"));
}

}  // namespace
}  // namespace shapeid::test
