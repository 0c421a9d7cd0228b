// What `inspect` says of a robot without a log, which would tell whether its base floats.
#include <gtest/gtest.h>

#include <string>

#include "shapeid/tests/app/command.hpp"

namespace shapeid::test {
namespace {

std::string arm_urdf(const std::string& above_root) {
  return R"(<robot name="arm">)" + above_root + R"(<link name="table"/>
  <link name="upper">
    <inertial><origin xyz="0.1 0.02 -0.3"/><mass value="1.5"/>
      <inertia ixx="0.05" ixy="0.001" ixz="0.002" iyy="0.06" iyz="-0.003" izz="0.02"/></inertial>
  </link>
  <link name="wrist"/>
  <joint name="shoulder" type="revolute"><parent link="table"/><child link="upper"/>
    <axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="50" velocity="20"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="wrist"/>
    <axis xyz="1 0 0"/><limit lower="-3" upper="3" effort="50" velocity="20"/></joint>
</robot>
)";
}

/// A base without mass cannot float: it is what an arm stands on, and nothing is wrong with it.
TEST(InspectRobot, TheRootOfAFixedBaseDoesNotMove) {
  const std::string file = scratch_file("arm.urdf", arm_urdf(""));
  for (const char* options : {"", " --json"}) {
    const CommandRun run = shapeid("inspect " + file + options);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("moves but has no mass: wrist"), std::string::npos) << run.out;
  }
}

TEST(InspectRobot, ABaseThatIsSaidToFloatMoves) {
  const std::string floating = R"(<link name="world"/>
  <joint name="free" type="floating"><parent link="world"/><child link="table"/></joint>)";
  const CommandRun run = shapeid("inspect " + scratch_file("floats.urdf", arm_urdf(floating)));
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("moves but has no mass: table, wrist"), std::string::npos) << run.out;
}

}  // namespace
}  // namespace shapeid::test
