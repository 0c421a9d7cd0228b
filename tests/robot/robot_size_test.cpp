// What tells metres from millimetres.
#include "shapeid/models/robot_size.hpp"

#include <gtest/gtest.h>

#include "shapeid/models/urdf.hpp"

namespace shapeid {
namespace {

/// A mast, a boom that slides along it, and an arm at its end: nothing along one axis alone.
Robot crane(const std::string& travel) {
  return parse_urdf(R"(<robot name="crane">
  <link name="mast"><inertial><origin xyz="0 0 9"/><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="boom"><inertial><origin xyz="1 0 0"/><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="arm"><inertial><origin xyz="0 0 -1"/><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="hook"/>
  <joint name="lift" type="prismatic"><origin xyz="3 0 4"/><parent link="mast"/><child link="boom"/>
    <axis xyz="0 0 1"/><limit )" +
                        travel + R"( effort="9" velocity="9"/></joint>
  <joint name="turn" type="continuous"><origin xyz="0 2 0"/><parent link="boom"/><child link="arm"/>
    <axis xyz="0 1 0"/></joint>
  <joint name="hang" type="fixed"><origin xyz="0 0 -2.5"/><parent link="arm"/><child link="hook"/></joint>
</robot>)",
                    "crane.urdf")
      .robot;
}

TEST(RobotSize, IsTheLongestWayThroughJointsAndTravel) {
  EXPECT_DOUBLE_EQ(size_of(crane(R"(lower="-1.5" upper="0.5")")), 5.0 + 1.5 + 2.0 + 2.5);
}

TEST(RobotSize, OfAShortChainIsThatOfItsBase) {
  Robot robot = crane(R"(lower="-1" upper="1")");
  robot.links.resize(1);
  EXPECT_DOUBLE_EQ(size_of(robot), 9.0);
}

TEST(RobotSize, ThirtyTimesAsFarIsTooFar) {
  Robot robot = crane(R"(lower="-1.5" upper="0.5")");
  EXPECT_FALSE(why_too_far(329.0, robot));
  EXPECT_EQ(why_too_far(331.0, robot), "331 m from the link's origin, on a robot of 11 m");
}

TEST(RobotSize, OfAPointMassNothingIsTooFar) {
  Robot robot = crane(R"(lower="-1" upper="1")");
  robot.links.resize(1);
  robot.links[0].inertia = from_centre(1.0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity());
  robot.links[0].members.clear();
  EXPECT_FALSE(why_too_far(1e3, robot));
}

}  // namespace
}  // namespace shapeid
