// A written URDF reads back with the same parameters, and differs nowhere else.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/robot/urdf_text.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::scaled_difference;
using test::WrittenRobot;

/// Any parameters that a link may be identified with: bodies inside the cone and on its edge.
rc::Gen<InertialParameters> identified_body() {
  const auto point = rc::gen::map(
      rc::gen::pair(test::magnitude(0.05, 5.0), test::vector3(0.4)), [](const auto& drawn) {
        return from_centre(drawn.first, drawn.second, Eigen::Matrix3d::Zero());
      });
  const auto rod =
      rc::gen::map(rc::gen::pair(point, point), [](const auto& p) { return p.first + p.second; });
  return rc::gen::oneOf(test::body(), point, rod);
}

RC_GTEST_PROP(UrdfWrite, ReadsBackWithTheSameParameters, ()) {
  const WrittenRobot written = *test::written_robot();
  const test::ScratchFolder folder;
  const std::string path = folder.write("original.urdf", written.text());
  const Robot robot = read_urdf(path).robot;
  std::vector<IdentifiedLink> identified;
  for (int i = 0; i < robot.link_count(); ++i) {
    if (*rc::gen::arbitrary<bool>()) identified.push_back({i, *identified_body()});
  }
  const Robot back = parse_urdf(write_urdf(path, robot, identified), "written.urdf").robot;
  RC_ASSERT(back.link_count() == robot.link_count());
  for (int i = 0; i < robot.link_count(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    InertialParameters expected = robot.links[k].inertia;
    for (const IdentifiedLink& one : identified) {
      if (one.link == i) expected = one.inertia;
    }
    RC_ASSERT(scaled_difference(back.links[k].inertia.values, expected.values, 10) <
              few_hundred_eps);
    RC_ASSERT(back.links[k].joint.placement.matrix() == robot.links[k].joint.placement.matrix());
  }
}

constexpr const char* original = R"(<?xml version="1.0"?>
<!-- a comment with <link name="x"> and <inertial> in it -->
<robot name='two "quoted" > words'>
  <material name="steel"/>
  <link name="world"/>
  <link name="body">   <!-- odd   spacing -->
      <inertial>
        <origin xyz="9 9 9"/><!-- inside -->
        <mass value="9"/>
        <inertia ixx="9" ixy="0" ixz="0" iyy="9" iyz="0" izz="9"/>
      </inertial >
    <visual name="a/>" note='b/>'><geometry><box size="1 1 1"/></geometry></visual>
  </link>
  <link name="plate"><inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link
     name="bare"/>
  <joint name="a" type="fixed"><origin xyz="1 0 0"/><parent link="world"/><child link="body"/></joint>
  <joint name="b" type="fixed"><parent link="body"/><child link="plate"/></joint>
  <joint name="c" type="revolute"><parent link="plate"/><child link="bare"/><axis xyz="0 0 1"/></joint>
  <!--><link name="neither"><inertial/></link>-->
  <gazebo><link name="body"><inertial/></link></gazebo>
</robot>
)";

// World carries body and plate. The sum goes to `body`, the first that had an inertia; the plate
// loses its own; the bare link gets its first. Nothing else changes.
constexpr const char* expected = R"(<?xml version="1.0"?>
<!-- a comment with <link name="x"> and <inertial> in it -->
<robot name='two "quoted" > words'>
  <material name="steel"/>
  <link name="world"/>
  <link name="body">   <!-- odd   spacing -->
      <inertial>
        <origin xyz="0 0 0.125" rpy="0 0 0"/>
        <mass value="4"/>
        <inertia ixx="0.5" ixy="0.125" ixz="0" iyy="0.75" iyz="0" izz="1"/>
      </inertial>
    <visual name="a/>" note='b/>'><geometry><box size="1 1 1"/></geometry></visual>
  </link>
  <link name="plate"><!-- its inertia is part of the link that it is fixed to --></link>
  <link
     name="bare">
    <inertial>
      <origin xyz="0.5 0 0" rpy="0 0 0"/>
      <mass value="2"/>
      <inertia ixx="0.25" ixy="0" ixz="0" iyy="0.25" iyz="0" izz="0.25"/>
    </inertial>
  </link>
  <joint name="a" type="fixed"><origin xyz="1 0 0"/><parent link="world"/><child link="body"/></joint>
  <joint name="b" type="fixed"><parent link="body"/><child link="plate"/></joint>
  <joint name="c" type="revolute"><parent link="plate"/><child link="bare"/><axis xyz="0 0 1"/></joint>
  <!--><link name="neither"><inertial/></link>-->
  <gazebo><link name="body"><inertial/></link></gazebo>
</robot>
)";

TEST(UrdfWrite, ChangesInertialsAndNothingElse) {
  const test::ScratchFolder folder;
  const std::string path = folder.write("original.urdf", original);
  const Robot robot = read_urdf(path).robot;
  Eigen::Matrix3d I;
  I << 0.5, 0.125, 0, 0.125, 0.75, 0, 0, 0, 1;
  // The body's frame stands at x = 1 of the world link, which is the lumped link.
  const auto base =
      moved(from_centre(4, {0, 0, 0.125}, I), Eigen::Isometry3d(Eigen::Translation3d(1, 0, 0)));
  const auto bare = from_centre(2, {0.5, 0, 0}, 0.25 * Eigen::Matrix3d::Identity());
  // All numbers are dyadic, so moving them there and back is exact.
  EXPECT_EQ(write_urdf(path, robot, {{0, base}, {1, bare}}), expected);
}

TEST(UrdfWrite, NothingIdentifiedIsTheSameText) {
  const test::ScratchFolder folder;
  const std::string path = folder.write("original.urdf", original);
  EXPECT_EQ(write_urdf(path, read_urdf(path).robot, {}), original);
}

TEST(UrdfWrite, MasslessLinkLosesItsInertial) {
  const test::ScratchFolder folder;
  const std::string path = folder.write("original.urdf", original);
  const Robot robot = read_urdf(path).robot;
  const std::string text = write_urdf(path, robot, {{0, InertialParameters{}}});
  EXPECT_NE(text.find("<!-- no mass was found here -->"), std::string::npos);
  EXPECT_EQ(parse_urdf(text, "w.urdf").robot.links[0].inertia.mass(), 0.0);
}

TEST(UrdfWrite, ImpossibleInertiaIsADefect) {
  const test::ScratchFolder folder;
  const std::string path = folder.write("original.urdf", original);
  const Robot robot = read_urdf(path).robot;
  const auto impossible =
      from_centre(1, {0, 0, 0}, Eigen::Vector3d(1, 2, 4).asDiagonal().toDenseMatrix());
  EXPECT_THROW(static_cast<void>(write_urdf(path, robot, {{1, impossible}})), Defect);
}

TEST(UrdfWrite, AnotherRobotsFileIsADefect) {
  const test::ScratchFolder folder;
  const std::string path = folder.write("original.urdf", original);
  const std::string other =
      folder.write("other.urdf", R"(<robot name="o"><link name="x"/></robot>)");
  const auto body = from_centre(1, {0, 0, 0}, Eigen::Matrix3d::Identity());
  EXPECT_THROW(static_cast<void>(write_urdf(other, read_urdf(path).robot, {{0, body}})), Defect);
}

// Joints stand in transmissions, comments and simulator settings, too: none of those is a joint of
// the robot. Both forms of <dynamics>, one too many, and none at all.
constexpr const char* jointed = R"(<robot name="j">
  <!-- <joint name="a"><dynamics damping="9"/></joint> -->
  <transmission name="t"><joint name="a"><dynamics damping="9"/></joint></transmission>
  <link name="r"/><link name="s"/><link name="t"/><link name="u"/>
  <gazebo><joint name="b"/></gazebo>
  <joint name="a" type="revolute"><!-- <dynamics/> -->
    <parent link="r"/><child link="s"/>
  </joint>
  <joint type="revolute" name="b"><parent link="s"/><child link="t"/>
    <dynamics damping="0.1"></dynamics>
    <dynamicsx damping="9"/><dynamics damping="0.2"/>
  </joint>
  <joint name='c' type="revolute"><parent link="t"/><dynamics friction="3"/><child link="u"/></joint>
</robot>
)";
constexpr const char* jointed_with_friction = R"(<robot name="j">
  <!-- <joint name="a"><dynamics damping="9"/></joint> -->
  <transmission name="t"><joint name="a"><dynamics damping="9"/></joint></transmission>
  <link name="r"/><link name="s"/><link name="t"/><link name="u"/>
  <gazebo><joint name="b"/></gazebo>
  <joint name="a" type="revolute">
    <dynamics damping="0.5" friction="0.25"/><!-- <dynamics/> -->
    <parent link="r"/><child link="s"/>
  </joint>
  <joint type="revolute" name="b"><parent link="s"/><child link="t"/>
    <dynamics damping="2" friction="0"/>
    <dynamicsx damping="9"/>
  </joint>
  <joint name='c' type="revolute"><parent link="t"/><dynamics damping="0" friction="1"/><child link="u"/></joint>
</robot>
)";

TEST(UrdfWrite, FrictionGoesToTheJointsOfTheRobot) {
  EXPECT_EQ(with_friction(jointed, "j.urdf", {{"a", {0.5, 0.25}}, {"b", {2, 0}}, {"c", {0, 1}}}),
            jointed_with_friction);
  EXPECT_EQ(with_friction(jointed, "j.urdf", {}), jointed);
}

TEST(UrdfWrite, FrictionOfAJointThatIsNotThereIsADefect) {
  EXPECT_THROW(static_cast<void>(with_friction(jointed, "j.urdf", {{"d", {1, 1}}})), Defect);
}

TEST(UrdfWrite, AJointThatClosesItselfIsRefused) {
  const std::string text =
      R"(<robot name="j"><link name="r"/><joint name="a" type="fixed"/></robot>)";
  EXPECT_THROW(static_cast<void>(with_friction(text, "j.urdf", {{"a", {1, 1}}})), InputError);
}

}  // namespace
}  // namespace shapeid
