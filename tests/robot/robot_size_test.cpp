// What tells metres from millimetres.
#include "shapeid/models/robot_size.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
  EXPECT_DOUBLE_EQ(size_of(robot), 9.0 + std::sqrt(1.5));  // tensors of 1 kg m^2, 1 kg
}

TEST(RobotSize, ThirtyTimesAsFarIsTooFar) {
  Robot robot = crane(R"(lower="-1.5" upper="0.5")");
  EXPECT_FALSE(why_too_far(329.0, robot));
  EXPECT_EQ(why_too_far(331.0, robot), "331 m from the link's origin, on a robot of 11 m");
}

/// Wherever its origin is, a body of one piece is as large as its inertia says.
TEST(RobotSize, OfOneBodyAboutItsCentreIsItsRadiusOfGyration) {
  Robot robot = crane(R"(lower="-1" upper="1")");
  robot.links.resize(1);
  robot.links[0].members.clear();
  robot.links[0].inertia = from_centre(2.0, Eigen::Vector3d(0.002, 0.0, 0.0),
                                       Eigen::Vector3d(0.02, 0.03, 0.04).asDiagonal());
  EXPECT_DOUBLE_EQ(size_of(robot), 0.002 + std::sqrt(0.5 * 0.09 / 2.0));
  EXPECT_FALSE(why_too_far(0.3, robot));
}

TEST(RobotSize, OfAPointMassNothingIsTooFar) {
  Robot robot = crane(R"(lower="-1" upper="1")");
  robot.links.resize(1);
  robot.links[0].inertia = from_centre(1.0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero());
  robot.links[0].members.clear();
  EXPECT_FALSE(why_too_far(1e3, robot));
}

}  // namespace
}  // namespace shapeid
