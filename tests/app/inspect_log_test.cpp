// shapeid inspect on logs: each column's range, and what a robot did in it, against logs of a few
// rows that can be counted by hand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/tests/app/command.hpp"

namespace shapeid::test {
namespace {

using nlohmann::json;

TEST(InspectLog, GivesEachColumnsRange) {
  scratch_file("four.csv", "time,a,b,c\n0,1,-2,\n1,,-4,\n2,3,7,\n4,-7,0.5,\n");
  const CommandRun run = shapeid("inspect --json four.csv");
  ASSERT_EQ(run.status, 0) << run.err;
  const auto column = [](const char* name, double lower, double mean, double upper, int numbers) {
    return json{{"name", name},   {"numbers", numbers}, {"empty", 4 - numbers},
                {"lower", lower}, {"upper", upper},     {"mean", mean}};
  };
  const json expected = {
      {"log", "four.csv"},
      {"rows", 4},
      {"columns",
       {column("time", 0.0, 1.75, 4.0, 4), column("a", -7.0, -1.0, 3.0, 3),
        column("b", -4.0, 0.375, 7.0, 4), json{{"name", "c"}, {"numbers", 0}, {"empty", 4}}}}};
  EXPECT_EQ(json::parse(run.out), expected) << run.out;

  const CommandRun text = shapeid("inspect four.csv");
  EXPECT_NE(text.out.find("log four.csv: 4 rows, 4 columns\n"), std::string::npos) << text.out;
  EXPECT_NE(
      text.out.find(fmt::format("  {:<32}{:>12}{:>12}{:>12}{:>9}\n", "a", "-7", "-1", "3", 1)),
      std::string::npos)
      << text.out;
}

/// A terminal acts on what stands between ESC and a letter.
TEST(InspectLog, NamesOfColumnsAreNoCommandsToATerminal) {
  scratch_file("colour.csv", "time,q.\x1b[31mred\n0,1\n1,2\n");
  const CommandRun run = shapeid("inspect colour.csv");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("q.\\x1b[31mred"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find('\x1b'), std::string::npos);
}

/// What a file is called says nothing of what is in it.
TEST(InspectLog, ARobotIsKnownByWhatIsInTheFile) {
  const std::string robot = "<robot name=\"r\"><link name=\"a\"/></robot>\n";
  for (const char* name : {"ARM.URDF", "arm.xacro", "arm"}) {
    scratch_file(name, std::string("\xEF\xBB\xBF \n") + robot);
    const CommandRun run = shapeid(std::string("inspect ") + name);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(run.out.starts_with("robot r: 1 links")) << run.out;
  }
}

/// A leg that hangs from a base, every sample of it as logged (--exact): the foot touches in the
/// first three quarters.
TEST(InspectLog, SaysWhatTheRobotDid) {
  scratch_file("hopper.urdf", R"(<robot name="hopper">
  <link name="trunk"><inertial><origin xyz="0.1 0 0"/><mass value="3"/>
    <inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="leg"><inertial><origin xyz="0 0 -0.2"/><mass value="0.5"/>
    <inertia ixx="0.004" iyy="0.005" izz="0.002" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="hip" type="revolute"><parent link="trunk"/><child link="leg"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="10" velocity="10"/></joint>
</robot>)");
  scratch_file("hopper.robot.yaml", "contacts: [{link: leg, point: [0, 0, -0.4]}]\n");
  std::string log =
      "time,base.gyro.x,base.gyro.y,base.gyro.z,base.gyrodot.x,base.gyrodot.y,base.gyrodot.z,"
      "base.accel.x,base.accel.y,base.accel.z,q.hip,dq.hip,ddq.hip,tau.hip,contact.leg,bus_"
      "voltage\n";
  constexpr int rows = 40;
  for (int i = 0; i < rows; ++i) {
    log += fmt::format("{},0.1,0.2,0.3,0,0,0,0,0,9.8,{},0,0,1.5,{},24\n", 0.01 * i, 0.001 * i,
                       i < rows * 3 / 4 ? 1 : 0);
  }
  scratch_file("hop.csv", log);
  const CommandRun run = shapeid("inspect hop.csv --robot hopper.urdf --exact --json");
  ASSERT_EQ(run.status, 0) << run.err;
  const json seen = json::parse(run.out);
  EXPECT_EQ(seen["rows"], rows);
  EXPECT_EQ(seen["gaps"], 0);
  EXPECT_EQ(seen["floating"], true);
  EXPECT_EQ(seen["contacts_derived"], false);
  EXPECT_EQ(seen["extra_columns"], json::array({"bus_voltage"}));
  EXPECT_NEAR(seen["rate"].get<double>(), 100.0, 1e-9);
  // What is left out about the lift-off is told; of the rest the foot touches in its share.
  const int samples = seen["samples"], dropped = seen["dropped_at_contacts"];
  EXPECT_EQ(samples + dropped + seen["dropped_at_ends"].get<int>(), rows) << run.out;
  const double share = seen["share_of_time_in_contact"]["leg"];
  EXPECT_GT(share, (rows * 0.75 - dropped) / samples - 1e-9) << run.out;
  EXPECT_LT(share, rows * 0.75 / samples + 1e-9) << run.out;
  const CommandRun text = shapeid("inspect hop.csv --robot hopper.urdf --exact");
  EXPECT_NE(text.out.find(fmt::format("{:<26} {}\n", "samples", samples)), std::string::npos)
      << text.out;
}

}  // namespace
}  // namespace shapeid::test
