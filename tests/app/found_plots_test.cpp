// Units on the axes of what stays unexplained.
#include "shapeid/app/found_plots.hpp"

#include <gtest/gtest.h>

#include "shapeid/diagnosis/slowness.hpp"
#include "shapeid/models/urdf.hpp"

namespace shapeid::test {
namespace {

Robot lift_and_arm() {
  return parse_urdf(R"(<robot name="lift">
  <link name="mast"/>
  <link name="sledge"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="arm"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="slide" type="prismatic"><parent link="mast"/><child link="sledge"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="1" effort="9" velocity="9"/></joint>
  <joint name="swing" type="continuous"><parent link="sledge"/><child link="arm"/>
    <axis xyz="0 1 0"/></joint>
</robot>)",
                    "lift.urdf", {.root = Root::fixed, .locked = {}})
      .robot;
}

/// Words of the picture of a curve of two points.
std::string drawn(const std::string& joint, const std::string& variable,
                  const std::string& law_unit = {}) {
  diagnosis::Structure s;
  s.joint = joint;
  s.variable = variable;
  s.at = {0.0, 1.0};
  s.value = {0.5, 0.7};
  if (!law_unit.empty()) s.law = "some_law@" + joint;
  s.law_unit = law_unit;
  return app::structure_picture(s, lift_and_arm());
}

void expect_labels(const std::string& picture, const std::string& along, const std::string& up) {
  EXPECT_NE(picture.find(">" + along + "<"), std::string::npos) << along << "\n" << picture;
  EXPECT_NE(picture.find(">" + up + "<"), std::string::npos) << up << "\n" << picture;
}

TEST(StructurePicture, SaysTheUnitsOfAJointThatTurns) {
  expect_labels(drawn("swing", "q.swing"), "q.swing (rad)", "residual (N m)");
  expect_labels(drawn("swing", "dq.swing"), "dq.swing (rad/s)", "residual (N m)");
  expect_labels(drawn("swing", "ddq.swing"), "ddq.swing (rad/s^2)", "residual (N m)");
  expect_labels(drawn("swing", "tau.swing"), "tau.swing (N m)", "residual (N m)");
  expect_labels(drawn("swing", "dtau.swing"), "dtau.swing (N m/s)", "residual (N m)");
}

TEST(StructurePicture, SaysTheUnitsOfAJointThatSlides) {
  expect_labels(drawn("slide", "q.slide"), "q.slide (m)", "residual (N)");
  expect_labels(drawn("slide", "ddq.slide"), "ddq.slide (m/s^2)", "residual (N)");
  expect_labels(drawn("slide", "dtau.slide"), "dtau.slide (N/s)", "residual (N)");
  expect_labels(drawn("slide", "dq.swing"), "dq.swing (rad/s)", "residual (N)");
}

/// The way since a joint turned round is a number from -1 to 1; a log's own columns have units
/// that nobody knows.
TEST(StructurePicture, SaysNoUnitWhereThereIsNone) {
  expect_labels(drawn("swing", "turn.swing"), "turn.swing", "residual (N m)");
  expect_labels(drawn("swing", "temperature"), "temperature", "residual (N m)");
}

TEST(StructurePicture, SaysTheUnitsOfTimeOfFrequencyAndOfALaw) {
  expect_labels(drawn("swing", "time"), "time (s)", "residual (N m)");
  expect_labels(drawn("slide", diagnosis::slow), "frequency (Hz)", "amplitude (N)");
  expect_labels(drawn("swing", "q.swing", "N m s"), "q.swing (rad)", "its number (N m s)");
}

}  // namespace
}  // namespace shapeid::test
