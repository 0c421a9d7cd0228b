// Lumping conserves mass, centre of mass and tensor, and keeps where everything is: held to sums
// over point masses that know nothing of links.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/robot/urdf_text.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::scaled_difference;
using test::WrittenRobot;

std::size_t index_of(const std::string& name) { return std::stoul(name.substr(1)); }

/// Coordinates of each lumped link to the root's, all joints at zero.
std::vector<Eigen::Isometry3d> poses(const Robot& robot) {
  std::vector<Eigen::Isometry3d> result;
  for (const Link& link : robot.links) {
    const bool root = link.parent < 0;
    result.push_back(root ? Eigen::Isometry3d::Identity()
                          : result[static_cast<std::size_t>(link.parent)] * link.joint.placement);
  }
  return result;
}

/// What link `index` was written with.
void expect_geometry(const CollisionBody& body, std::size_t index) {
  const double size = 1.0 + static_cast<double>(index);
  if (index % 3 == 0) {
    const Eigen::Vector3d sides(size, size + 0.25, size + 0.5);
    RC_ASSERT(std::get<Box>(body.geometry).size == sides);
  } else if (index % 3 == 1) {
    const auto& cylinder = std::get<CylinderGeometry>(body.geometry);
    RC_ASSERT(cylinder.radius == size);
    RC_ASSERT(cylinder.length == size + 0.25);
  } else {
    RC_ASSERT(std::get<SphereGeometry>(body.geometry).radius == size);
  }
}

RC_GTEST_PROP(UrdfLump, ConservesMassCentreAndTensor, ()) {
  const WrittenRobot written = *test::written_robot();
  const Robot robot = parse_urdf(written.text(), "written.urdf").robot;
  std::size_t members = 0;
  for (const Link& link : robot.links) {
    std::vector<std::size_t> which;
    for (const Member& member : link.members) which.push_back(index_of(member.name));
    members += which.size();
    const InertialParameters expected = written.summed(which, index_of(link.name));
    RC_ASSERT(scaled_difference(link.inertia.values, expected.values, 10) < few_hundred_eps);
  }
  RC_ASSERT(members == written.links.size());
}

RC_GTEST_PROP(UrdfLump, MembersJoinExactlyWhereTheirJointIsFixed, ()) {
  const WrittenRobot written = *test::written_robot();
  const Robot robot = parse_urdf(written.text(), "written.urdf").robot;
  for (std::size_t i = 1; i < written.links.size(); ++i) {
    const auto& link = written.links[i];
    const int own = robot.find_link(fmt::format("l{}", i)).value();
    const int parent = robot.find_link(fmt::format("l{}", link.parent)).value();
    RC_ASSERT((own == parent) == (link.joint == "fixed"));
    if (own == parent) continue;
    RC_ASSERT(robot.links[static_cast<std::size_t>(own)].parent == parent);
    RC_ASSERT(robot.links[static_cast<std::size_t>(own)].name == fmt::format("l{}", i));
  }
}

RC_GTEST_PROP(UrdfLump, EveryFrameAndCollisionBodyStaysWhereItWas, ()) {
  const WrittenRobot written = *test::written_robot();
  const Robot robot = parse_urdf(written.text(), "written.urdf").robot;
  const std::vector<Eigen::Isometry3d> pose = poses(robot);
  for (std::size_t k = 0; k < robot.links.size(); ++k) {
    const Link& link = robot.links[k];
    RC_ASSERT(link.collision.size() == link.members.size());
    for (std::size_t i = 0; i < link.members.size(); ++i) {
      const std::size_t index = index_of(link.members[i].name);
      const Eigen::Matrix4d frame = (pose[k] * link.members[i].pose).matrix();
      RC_ASSERT(scaled_difference(frame, written.pose(index), 12) < few_hundred_eps);
      const CollisionBody& body = link.collision[i];
      const Eigen::Matrix4d whole = (pose[k] * body.pose).matrix();
      RC_ASSERT(scaled_difference(whole, written.collision_pose(index), 12) < few_hundred_eps);
      expect_geometry(body, index);
    }
  }
}

// The promised order, checked against its definition: whenever a joint was placed, no joint that
// stands earlier in the file was ready.
RC_GTEST_PROP(UrdfLump, JointsFollowTheDocumentAmongThoseReady, ()) {
  const WrittenRobot written = *test::written_robot();
  const Robot robot = parse_urdf(written.text(), "written.urdf").robot;
  std::map<std::string, std::size_t> place;
  for (std::size_t k = 0; k < written.joint_order.size(); ++k) {
    place[fmt::format("j{}", written.joint_order[k])] = k;
  }
  for (int j = 0; j < robot.joint_count(); ++j) {
    for (int later = j + 1; later < robot.joint_count(); ++later) {
      const int parent = robot.links[static_cast<std::size_t>(later) + 1].parent;
      const bool was_ready = parent <= j;
      RC_ASSERT(!was_ready || place.at(robot.joint(j).name) < place.at(robot.joint(later).name));
    }
  }
}

RC_GTEST_PROP(UrdfLump, JointsKeepKindAxisAndLimits, ()) {
  const WrittenRobot written = *test::written_robot();
  const Robot robot = parse_urdf(written.text(), "written.urdf").robot;
  for (int j = 0; j < robot.joint_count(); ++j) {
    const Joint& joint = robot.joint(j);
    const auto& link = written.links[index_of(joint.name)];
    const std::map<std::string, JointKind> kinds = {{"revolute", JointKind::revolute},
                                                    {"continuous", JointKind::continuous},
                                                    {"prismatic", JointKind::prismatic}};
    RC_ASSERT(joint.kind == kinds.at(link.joint));
    RC_ASSERT(scaled_difference(joint.axis, link.axis, 3) < few_hundred_eps);
    RC_ASSERT(joint.effort == 30.0);
    RC_ASSERT(joint.velocity == 7.0);
    const bool limited = joint.kind != JointKind::continuous;
    RC_ASSERT(joint.lower == (limited ? -1.0 : -std::numeric_limits<double>::infinity()));
    RC_ASSERT(joint.upper == (limited ? 2.0 : std::numeric_limits<double>::infinity()));
  }
}

constexpr const char* gripper = R"(<robot name="gripper">
  <link name="hand"/>
  <link name="finger">
    <inertial><origin xyz="0.1 0 0"/><mass value="2"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.015"/></inertial>
  </link>
  <link name="tip">
    <inertial><mass value="1"/>
      <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial>
  </link>
  <joint name="close" type="revolute">
    <origin xyz="0 0 1"/><parent link="hand"/><child link="finger"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="slide" type="prismatic">
    <origin xyz="0.2 0 0"/><parent link="finger"/><child link="tip"/><axis xyz="0 2 0"/>
    <mimic joint="close" multiplier="0.1" offset="0.05"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>)";

// At close = 90 degrees the finger's x axis is the hand's y axis. By hand: finger's centre at
// (0, 0.1, 1); tip slid s = 0.05 + 0.1 close along finger y, at finger (0.2, s, 0), hand (-s, 0.2,
// 1).
TEST(UrdfLump, LockedJointsStandWhereTheyAreTold) {
  UrdfOptions options;
  options.lock_mimic = true;
  options.locked = {{"close", std::acos(0.0)}};
  const Robot robot = parse_urdf(gripper, "gripper.urdf", options).robot;
  ASSERT_EQ(robot.link_count(), 1);
  EXPECT_EQ(robot.links[0].inertia.mass(), 3.0);
  const Eigen::Vector3d expected(-0.05 - 0.1 * std::acos(0.0), 0.2 + 2 * 0.1, 3.0);
  EXPECT_LT(scaled_difference(robot.links[0].inertia.first_moment(), expected, 3), few_hundred_eps);
  EXPECT_EQ(robot.notes, (std::vector<std::string>{
                             "axis scaled to length one: slide", "joints locked at 1.5708: close",
                             "mimic joints locked at 0.20708: slide",
                             "hand also carries what is fixed to it: finger, tip"}));
}

TEST(UrdfLump, SlowJointsAndMimicsWithoutAnOffset) {
  std::string text = gripper;
  const std::string offset = " offset=\"0.05\"", fast = "velocity=\"1\"";
  text.erase(text.find(offset), offset.size());
  text.replace(text.find(fast), fast.size(), "velocity=\"0.25\"");
  UrdfOptions options;
  options.lock_mimic = true;
  const Robot robot = parse_urdf(text, "gripper.urdf", options).robot;
  ASSERT_EQ(robot.joint_count(), 1);
  EXPECT_EQ(robot.joint(0).velocity, 0.25);
  ASSERT_GE(robot.notes.size(), 2u);
  EXPECT_EQ(robot.notes[1], "mimic joints locked at 0: slide");
}

/// A mimic of a mimic, whose master is locked, and two that follow each other.
TEST(UrdfLump, MimicsOfMimics) {
  const auto locked_at = [](const std::string& last_master, const std::string& first_master) {
    const auto joint = [](int i, const std::string& mimic) {
      return fmt::format(
          R"(<joint name="j{0}" type="prismatic"><parent link="l{0}"/><child link="l{1}"/>
<axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="1" velocity="1"/>{2}</joint>)",
          i, i + 1, mimic);
    };
    std::string text = R"(<robot name="r">)";
    for (int i = 0; i < 4; ++i) text += fmt::format(R"(<link name="l{}"/>)", i);
    text +=
        joint(0, first_master) + joint(1, R"(<mimic joint="j0" multiplier="2" offset="0.25"/>)") +
        joint(2, fmt::format(R"(<mimic joint="{}" multiplier="-3" offset="0.5"/>)", last_master));
    UrdfOptions options;
    options.lock_mimic = true;
    if (first_master.empty()) options.locked = {{"j0", 0.75}};
    const Robot robot = parse_urdf(text + "</robot>", "r.urdf", options).robot;
    return robot.links[0].members.back().pose.translation().x();
  };
  // j0 + (0.25 + 2 j0) + (0.5 - 3 (0.25 + 2 j0)) with j0 = 0.75.
  EXPECT_DOUBLE_EQ(locked_at("j1", ""), 0.75 + 1.75 + 0.5 - 3.0 * 1.75);
  const auto refusal = [&](const char* last_master, const char* first_master) -> std::string {
    try {
      static_cast<void>(locked_at(last_master, first_master));
    } catch (const InputError& e) {
      return e.what();
    }
    return "accepted";
  };
  // In a circle none of them stands anywhere.
  EXPECT_NE(refusal("j1", R"(<mimic joint="j2"/>)").find("mimics itself, by others or directly"),
            std::string::npos);
  EXPECT_NE(refusal("j2", "").find("joint j2 mimics itself"), std::string::npos);
  EXPECT_NE(refusal("k", "").find("joint j2 mimics k, which is no joint"), std::string::npos);
}

/// Joints that follow each other, as many as a file holds, in no more time than that takes.
TEST(UrdfLump, AChainOfMimicsIsFollowed) {
  constexpr int count = 900;
  std::string text = R"(<robot name="r"><link name="l0"/>)";
  for (int i = 0; i < count; ++i) {
    const std::string mimic =
        i == 0 ? "" : fmt::format(R"(<mimic joint="j{}" offset="0.001"/>)", i - 1);
    text += fmt::format(
        R"(<link name="l{1}"/><joint name="j{0}" type="prismatic"><parent link="l{0}"/>
<child link="l{1}"/><axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="1" velocity="1"/>{2}
</joint>)",
        i, i + 1, mimic);
  }
  UrdfOptions options;
  options.lock_mimic = true;
  const Robot robot = parse_urdf(text + "</robot>", "r.urdf", options).robot;
  ASSERT_EQ(robot.link_count(), 2);
  const double sum = 0.001 * count * (count - 1) / 2.0;
  EXPECT_NEAR(robot.links[1].members.back().pose.translation().x(), sum, 1e-9 * sum);
}

TEST(UrdfLump, MembersKnowTheirLines) {
  const std::string text = R"(<robot name="r">
<link name="a"/>

<link name="b"/>
<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>
</robot>)";
  const Robot robot = parse_urdf(text, "r.urdf").robot;
  ASSERT_EQ(robot.link_count(), 1);
  ASSERT_EQ(robot.links[0].members.size(), 2U);
  EXPECT_EQ(robot.links[0].members[0].line, 2);
  EXPECT_EQ(robot.links[0].members[1].line, 4);
}

// The shortest direction that six decimals can write, and what is no direction.
TEST(UrdfLump, AxesAreAsShortAsTheirDecimals) {
  const auto axis = [](const std::string& xyz) {
    const std::string text =
        R"(<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="continuous">
<parent link="a"/><child link="b"/><axis xyz=")" +
        xyz + R"("/></joint></robot>)";
    return parse_urdf(text, "r.urdf").robot.joint(0).axis;
  };
  EXPECT_EQ(axis("0 0.000001 0"), Eigen::Vector3d::UnitY());
  EXPECT_THROW(static_cast<void>(axis("0 0.0000009 0")), InputError);
}

TEST(UrdfLump, LockOfAnUnknownJointIsRefused) {
  UrdfOptions options;
  options.locked = {{"opne", 0.0}};
  try {
    static_cast<void>(parse_urdf(gripper, "gripper.urdf", options));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "joint opne cannot be locked at 0: gripper.urdf has no such moving joint; name a "
                 "joint of the URDF");
  }
}

TEST(UrdfLump, FloatingJointFromAnEmptyWorldMakesItsChildTheRoot) {
  const std::string text = R"(<robot name="r"><link name="world"/>
<link name="body"><inertial><mass value="2"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1.5"/></inertial></link>
<joint name="free" type="floating"><parent link="world"/><child link="body"/></joint></robot>)";
  const Robot floating = parse_urdf(text, "r.urdf").robot;
  ASSERT_EQ(floating.link_count(), 1);
  EXPECT_EQ(floating.links[0].name, "body");
  EXPECT_EQ(floating.root, Root::floating);
  EXPECT_EQ(floating.notes,
            std::vector<std::string>{"floating joint free left out: body is the floating root"});
  const Robot fixed = parse_urdf(text, "r.urdf", {.root = Root::fixed, .locked = {}}).robot;
  EXPECT_EQ(fixed.root, Root::fixed);
  EXPECT_EQ(fixed.notes, std::vector<std::string>{
                             "floating joint free left out: body is the fixed (as asked) root"});
  std::string turned = text;
  turned.insert(turned.find("</joint>"), R"(<origin rpy="1.57 0 0"/>)");
  const std::string note =
      parse_urdf(turned, "r.urdf", {.root = Root::fixed, .locked = {}}).robot.notes.front();
  EXPECT_NE(note.find("upright: how the joint's origin turns it is left out"), std::string::npos);
  EXPECT_EQ(parse_urdf(turned, "r.urdf").robot.notes, floating.notes);
}

/// Half a limit is not none: URDF's default is zero.
TEST(UrdfLump, SaysWhichLimitIsZero) {
  for (const auto& [given, other] : {std::pair("lower", "upper"), std::pair("upper", "lower")}) {
    const std::string text = fmt::format(
        R"(<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="revolute">
<parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit {}="{}" effort="1" velocity="1"/></joint></robot>)",
        given, given == std::string("lower") ? -2 : 2);
    const Robot robot = parse_urdf(text, "r.urdf").robot;
    EXPECT_EQ(robot.notes.front(), fmt::format("no {} limit, taken as 0: j", other));
    EXPECT_EQ(robot.joint(0).upper - robot.joint(0).lower, 2.0);
  }
}

TEST(UrdfLump, SaysWhatItTookForGranted) {
  const std::string text = R"(<robot name="r"><link name="a"/><link name="b"/><link name="c">
<collision><geometry><capsule radius="1" length="2"/></geometry></collision></link>
<link name="d"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/></joint>
<joint name="k" type="revolute"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/>
<limit effort="0" velocity="3"/></joint>
<joint name="l" type="fixed"><parent link="c"/><child link="d"/><axis xyz="0 0 0"/></joint>
</robot>)";
  const std::vector<std::string> expected = {
      "collision geometry that is no box, cylinder, sphere or mesh left out: c",
      "no <axis>, taken as x: j",
      "no <limit>, taken as none: j",
      "effort limit is 0, taken as none: k",
      "lower and upper limit are equal or missing, taken as none: k",
      "c also carries what is fixed to it: d",
      "moves but has no mass: a, b, c"};
  EXPECT_EQ(parse_urdf(text, "r.urdf").robot.notes, expected);
}

}  // namespace
}  // namespace shapeid
