// A name that is misspelt leaves a default in its place: the reader says so, with the line, and is
// silent about what URDF files really hold besides.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "shapeid/models/urdf.hpp"

namespace shapeid {
namespace {

using NoteLines = std::vector<std::string>;

/// A link in line 2, one in line 3, a joint in line 4.
std::string link_and_joint(const std::string& link, const std::string& joint) {
  return "<robot name=\"r\">\n<link name=\"a\"/>\n<link name=\"b\">" + link + "</link>\n" +
         R"(<joint name="j" type="revolute"><parent link="a"/><child link="b"/>)" + joint +
         "</joint>\n</robot>\n";
}

constexpr const char* mass_one =
    R"(<mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>)";
constexpr const char* axis_and_limit =
    R"(<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>)";

NoteLines notes_of(const std::string& link, const std::string& joint = axis_and_limit) {
  UrdfOptions options;
  options.root = Root::fixed;
  return parse_urdf(link_and_joint(link, joint), "r.urdf", options).robot.notes;
}

std::string element_with(const std::string& element, const std::string& inside) {
  return "<" + element + ">" + inside + "</" + element + ">";
}

TEST(UrdfUnread, MisspeltNamesAreNotesWithTheirLines) {
  const std::string whole = element_with("inertial", mass_one);
  const auto of_inertial = [](const std::string& more) {
    return notes_of(element_with("inertial", more + mass_one));
  };
  const auto of_joint = [&](const std::string& joint) { return notes_of(whole, joint); };
  const std::string axis = R"(<axis xyz="0 0 1"/>)";
  const std::string limit = R"(<limit lower="-1" upper="1" effort="1" velocity="1"/>)";

  EXPECT_EQ(of_inertial(R"(<orign xyz="1 0 0"/>)"),
            NoteLines{"unknown <orign> in <inertial> is not read: link b (line 3)"});
  EXPECT_EQ(of_inertial(R"(<origin xzy="1 0 0"/>)"),
            NoteLines{"unknown attribute xzy of <origin> is not read: link b (line 3)"});
  EXPECT_EQ(notes_of(element_with("inertial",
                                  R"(<mass value="1" vaule="2"/>)"
                                  R"(<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1")"
                                  R"( iyx="1"/>)")),
            (NoteLines{"unknown attribute vaule of <mass> is not read: link b (line 3)",
                       "unknown attribute iyx of <inertia> is not read: link b (line 3)"}));
  EXPECT_EQ(of_joint(axis + limit + R"(<orign xyz="1 0 0"/>)"),
            NoteLines{"unknown <orign> in <joint> is not read (<origin>?): joint j (line 4)"});
  EXPECT_EQ(of_joint(limit + R"(<axis xyz="0 0 1" xzy="1 0 0"/>)"),
            NoteLines{"unknown attribute xzy of <axis> is not read: joint j (line 4)"});
  EXPECT_EQ(of_joint(axis + R"(<limit lower="-1" uper="1" effort="1" velocity="1"/>)"),
            (NoteLines{"no upper limit, taken as 0: j",
                       "unknown attribute uper of <limit> is not read: joint j (line 4)"}));
  EXPECT_EQ(notes_of(whole + element_with("colision", "")),
            NoteLines{"unknown <colision> in <link> is not read (<collision>?): link b (line 3)"});
  EXPECT_EQ(notes_of(whole + R"(<collision><Origin xyz="1 0 0"/><geometry><sphere radius="1"/>)"
                             R"(<cone/></geometry></collision>)"),
            (NoteLines{"unknown <Origin> in <collision> is not read (<origin>?): link b (line 3)",
                       "<cone> beside <sphere> in one <geometry> is left out: link b (line 3)"}));
  EXPECT_EQ(notes_of(whole + R"(<collision><geometry><sphere radius="1"/><box size="1 1 1"/>)"
                             R"(</geometry></collision>)"),
            NoteLines{"<sphere> beside <box> in one <geometry> is left out: link b (line 3)"});
}

TEST(UrdfUnread, OneLetterMoreLessOrChangedOrTwoExchanged) {
  for (const char* name : {"inertail", "inertia", "inertiall", "Inertial", "imertial"}) {
    const NoteLines found = notes_of(element_with(name, mass_one));
    ASSERT_FALSE(found.empty()) << name;
    EXPECT_EQ(found[0], std::string("unknown <") + name +
                            "> in <link> is not read (<inertial>?): link b (line 3)");
  }
  for (const char* name : {"inrteial", "initial", "material", "inertials2"}) {
    for (const std::string& note : notes_of(element_with(name, ""))) {
      EXPECT_EQ(note.find("not read"), std::string::npos) << note;
    }
  }
}

/// What exporters and simulators write, in the places where they write it.
TEST(UrdfUnread, WhatUrdfFilesHoldBesidesIsNoReasonForANote) {
  const std::string link =
      element_with("inertial", mass_one) +
      R"(<visual><origin xyz="0 0 0" rpy="0 0 0"/><geometry><mesh filename="m.stl"/></geometry>)"
      R"(<material name="m"><color rgba="0 0 0 1"/></material></visual>)"
      R"(<collision name="c"><origin xyz="0 0 0" rpy="0 0 0"/><geometry><sphere radius="1"/>)"
      R"(</geometry><contact_coefficients mu="0"/><material name="m"/><verbose value="x"/>)"
      R"(<drake:proximity_properties/></collision>)"
      R"(<contact><lateral_friction value="1"/></contact><self_collision_checking/>)"
      R"(<gravity/><sensor/><lumped/><velocity_decay/>)";
  const std::string joint =
      R"(<origin xyz="0 0 0" rpy="0 0 0"/><axis xyz="0 0 1"/>)"
      R"(<limit lower="-1" upper="1" effort="1" velocity="1" drake:acceleration="1" current="8"/>)"
      R"(<dynamics damping="0.1" friction="0.2"/><calibration rising="0"/>)"
      R"(<safety_controller k_velocity="1"/><joint_properties damping="0"/><hardwareInterface/>)";
  EXPECT_EQ(notes_of(link, joint), NoteLines{});
}

}  // namespace
}  // namespace shapeid
