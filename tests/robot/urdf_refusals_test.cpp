// Every way in which a URDF can be wrong, with the one line that the user reads.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/urdf.hpp"

namespace shapeid {
namespace {

struct Broken {
  const char* what;
  std::string text;
  const char* message;
};

/// A robot of links a and b and a joint j between them, each of which a case may replace. Link a
/// stands in line 2, link b in line 3, the joint in line 4.
struct Parts {
  std::string a = R"(<link name="a"/>)";
  std::string b = R"(<link name="b"/>)";
  std::string j =
      R"(<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>)";
  std::string more{};
};

std::string robot(const Parts& p) {
  return "<robot name=\"r\">\n" + p.a + "\n" + p.b + "\n" + p.j + "\n" + p.more + "</robot>\n";
}

std::string inertial(
    const std::string& mass, const std::string& origin = "",
    const std::string& inertia = R"(<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>)") {
  return robot({.a = "<link name=\"a\">\n<inertial>\n" + origin + "<mass value=\"" + mass +
                     "\"/>\n" + inertia + "</inertial></link>"});
}

std::string joint(const std::string& type, const std::string& inside) {
  return robot({.j = "<joint name=\"j\" type=\"" + type +
                     "\">\n<parent link=\"a\"/><child link=\"b\"/>" + inside + "</joint>"});
}

std::string between(const char* name, const char* parent, const char* child) {
  return std::string("<joint name=\"") + name + R"(" type="fixed"><parent link=")" + parent +
         R"("/><child link=")" + child + "\"/></joint>\n";
}

std::string collision(const std::string& geometry) {
  return robot({.a = "<link name=\"a\"><collision>\n<geometry>" + geometry +
                     "</geometry></collision></link>"});
}

std::string nested(int levels) {
  std::string inside;
  for (int i = 0; i < levels; ++i) inside.insert(0, "<x>").append("</x>");
  return robot({.more = inside + "\n"});
}

const std::vector<Broken>& cases();

class UrdfRefusals : public testing::TestWithParam<std::size_t> {};

TEST_P(UrdfRefusals, SaysWhatIsWrongAndWhatWouldBeRight) {
  const Broken& broken = cases()[GetParam()];
  try {
    static_cast<void>(parse_urdf(broken.text, "r.urdf"));
    ADD_FAILURE() << broken.what << " was accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), broken.message) << broken.what;
  }
}

const std::vector<Broken>& cases() {
  static const std::vector<Broken> all = {
      {"EmptyFile", "", "r.urdf: the file is empty; give a URDF"},
      {"NotXml", "time,q.hip\n0,1\n",
       "r.urdf:1: not well-formed XML (XML_ERROR_PARSING_TEXT); give a URDF"},
      {"Unclosed", "<robot name=\"r\">\n<link name=\"a\">\n</robot>",
       "r.urdf:2: not well-formed XML: an element is not closed, or another one is; give a URDF"},
      {"AnotherRoot", "<sdf/>",
       "r.urdf:1: the outermost element is <sdf>; a URDF begins with <robot>"},
      {"TwoRobots", robot({}) + "<robot/>",
       "r.urdf:6: something follows </robot>; one file holds one robot"},
      {"ZeroByte", robot({}) + std::string(1, '\0'),
       "r.urdf:6: a zero byte: this is not XML text; give a URDF"},
      {"EntityDeclaration", "<!DOCTYPE robot [<!ENTITY m \"1\">]>\n" + robot({}),
       "r.urdf:1: a document type or entity declaration (\"<!\"); a URDF needs none: remove it"},
      {"RepeatedAttribute", robot({.a = R"(<link name="a" name="c"/>)"}),
       "r.urdf:2: not well-formed XML: an attribute is malformed, or given twice; give a URDF"},
      {"NestedTooDeep", nested(150),
       "r.urdf:5: elements are nested more than 100 deep; give a URDF"},
      {"TooLarge", robot({.more = std::string(std::size_t{1} << 24, ' ')}),
       "r.urdf: 16777371 bytes, more than 16777216; is this a URDF?"},
      {"NoLinks", "<robot name=\"r\"/>",
       "r.urdf:1: the robot has no <link>; a URDF has one at least"},
      {"MassNan", inertial("nan"),
       "r.urdf:4: value of <mass> is not a finite number (\"nan\"); write a finite decimal number"},
      {"MassInfinite", inertial("inf"),
       "r.urdf:4: value of <mass> is not a finite number (\"inf\"); write a finite decimal number"},
      {"MassOverflow", inertial("1e999"),
       "r.urdf:4: value of <mass> does not fit into a double (\"1e999\"); write a finite decimal "
       "number"},
      {"MassUnderflow", inertial("1e-999"),
       "r.urdf:4: value of <mass> does not fit into a double (\"1e-999\"); write a finite decimal "
       "number"},
      {"MassWithTail", inertial("1abc"),
       "r.urdf:4: value of <mass> is not a number (\"1abc\"); write a finite decimal number"},
      {"MassHexadecimal", inertial("0x10"),
       "r.urdf:4: value of <mass> is not a number (\"0x10\"); write a finite decimal number"},
      {"MassWithComma", inertial("1,5"),
       "r.urdf:4: value of <mass> is not a number (\"1,5\": decimals take a point, not a comma); "
       "write a finite decimal number"},
      {"MassEmpty", inertial(""),
       "r.urdf:4: value of <mass> is empty; write a finite decimal number"},
      {"MassTwoSigns", inertial("+-1"),
       "r.urdf:4: value of <mass> is not a number (\"+-1\"); write a finite decimal number"},
      {"MassTwoNumbers", inertial("1 2"),
       "r.urdf:4: value of <mass> is not a number (\"1 2\"); write a finite decimal number"},
      {"MassInXacro", inertial("${mass}"),
       "r.urdf:4: value of <mass> is a xacro expression (\"${mass}\"); expand the file first; "
       "write a finite decimal number"},
      {"MacroNotExpanded", inertial("1", "<xacro:arm prefix=\"left\"/>\n"),
       "r.urdf:4: <xacro:arm> is of xacro, which is not expanded here; expand the file first: "
       "xacro FILE > robot.urdf"},
      {"RpyInDegrees", inertial("1", "<origin rpy=\"0 -90 0\"/>\n"),
       "r.urdf:4: rpy of <origin> turns by 90; radians, a turn at most"},
      {"MassBeyondReason", inertial("1e12"),
       "r.urdf:4: value of <mass> is 1e+12; SI units; nothing here exceeds 1e+09"},
      {"TwoNumbersForXyz", inertial("1", "<origin xyz=\"0 1\"/>\n"),
       "r.urdf:4: xyz of <origin> has 2 numbers (\"0 1\"); write three, with blanks between them"},
      {"FourNumbersForXyz", inertial("1", "<origin xyz=\"0 1 2 3\"/>\n"),
       "r.urdf:4: xyz of <origin> has 4 numbers (\"0 1 2 3\"); write three, with blanks between "
       "them"},
      {"NanInRpy", inertial("1", "<origin rpy=\"0 nan 0\"/>\n"),
       "r.urdf:4: rpy of <origin> is not a finite number (\"nan\"); write a finite decimal number"},
      {"XyzWithCommas", inertial("1", "<origin xyz=\"0, 1, 2\"/>\n"),
       "r.urdf:4: xyz of <origin> is not a number (\"0,\": decimals take a point, not a comma); "
       "write a finite decimal number"},
      {"NoMass", robot({.a = "<link name=\"a\"><inertial/></link>"}),
       "r.urdf:2: <inertial> has no <mass>; write <mass value=\"...\"/>"},
      {"NoMassValue", robot({.a = "<link name=\"a\"><inertial>\n<mass/></inertial></link>"}),
       "r.urdf:3: <mass> has no attribute \"value\"; write it, also where it is zero"},
      {"NoInertia", inertial("1", "", ""),
       "r.urdf:3: <inertial> has no <inertia>; write <inertia ixx ixy ixz iyy iyz izz/>, zero for "
       "a point mass"},
      {"MissingIzz", inertial("1", "", R"(<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0"/>)"),
       "r.urdf:5: <inertia> has no attribute \"izz\"; write it, also where it is zero"},
      {"TwoInertials", robot({.a = "<link name=\"a\">\n<inertial/>\n<inertial/></link>"}),
       "r.urdf:4: a second <inertial> in <link>; keep one"},
      {"NegativeMass", inertial("-1"),
       "r.urdf:3: inertia of link a: mass is negative (-1 kg); correct it, leave it out, or read "
       "it with reject_impossible = false where the link is known"},
      {"MomentsWithoutMass", inertial("0"),
       "r.urdf:3: inertia of link a: the body has moments but no mass; correct it, leave it out, "
       "or read it with reject_impossible = false where the link is known"},
      {"ImpossibleTensor",
       inertial("1", "", R"(<inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="4"/>)"),
       "r.urdf:3: inertia of link a: the triangle inequality is broken: principal moments 1 + 2 < "
       "4 kg m^2 (short by 1); correct it, leave it out, or read it with reject_impossible = false "
       "where "
       "the link is known"},
      {"NamelessLink", robot({.a = "<link/>"}),
       "r.urdf:2: <link> has no attribute \"name\"; name it"},
      {"EmptyName", robot({.a = R"(<link name=""/>)"}),
       "r.urdf:2: the name of <link> is empty; use letters, digits and underscores"},
      {"BlankAroundName", robot({.a = R"(<link name="a "/>)"}),
       "r.urdf:2: the name of <link> has blanks around it; use letters, digits and underscores"},
      {"ControlCharacterInName", robot({.a = "<link name=\"a\tb\"/>"}),
       "r.urdf:2: the name of <link> has a control character; use letters, digits and underscores"},
      {"NameInLatin1", robot({.a = "<link name=\"f\xFC\xDF\"/>"}),
       "r.urdf:2: the name of <link> is not UTF-8 text; use letters, digits and underscores"},
      {"SameLinkTwice", robot({.more = "<link name=\"a\"/>\n"}),
       "r.urdf:5: a second link a (the first is in line 2); names must differ"},
      {"SameJointTwice", robot({.more = "<link name=\"c\"/>\n" + between("j", "b", "c")}),
       "r.urdf:6: a second joint j (the first is in line 4); names must differ"},
      {"UnknownParent", robot({.j = between("j", "x", "b")}),
       "r.urdf:4: joint j: no link is named x; name a link of this file as its parent"},
      {"UnknownChild", robot({.j = between("j", "a", "x")}),
       "r.urdf:4: joint j: no link is named x; name a link of this file as its child"},
      {"TwoParents",
       robot({.more = "<link name=\"c\"/>\n" + between("k", "a", "c") + between("l", "b", "c")}),
       "r.urdf:7: link c has two parents: joints k and l; a robot is a tree: remove one of the "
       "joints"},
      {"OwnParent", robot({.b = "", .j = between("j", "a", "a")}),
       "r.urdf:2: every link has a parent, so the joints form a cycle; a robot is a tree: remove a "
       "joint"},
      {"Cycle", robot({.more = between("k", "b", "a")}),
       "r.urdf:2: every link has a parent, so the joints form a cycle; a robot is a tree: remove a "
       "joint"},
      {"TwoRoots", robot({.more = "<link name=\"c\"/>\n"}),
       "r.urdf:5: links a and c both have no parent; a robot is one tree: join them, or remove "
       "one"},
      {"DetachedCycle",
       robot({.more = "<link name=\"c\"/>\n<link name=\"d\"/>\n" + between("k", "c", "d") +
                      between("l", "d", "c")}),
       "r.urdf:5: link c is on a cycle of joints, or hangs on one, apart from a; a robot is a "
       "tree: remove a joint"},
      {"NoType", robot({.j = R"(<joint name="j"><parent link="a"/><child link="b"/></joint>)"}),
       "r.urdf:4: <joint> has no attribute \"type\"; name it"},
      {"UnknownType", joint("hinge", ""),
       "r.urdf:4: joint j has the unknown type hinge; known types are fixed, revolute, continuous, "
       "prismatic, floating"},
      {"Planar", joint("planar", ""),
       "r.urdf:4: joint j is planar; write it as two prismatic joints and a revolute one"},
      {"FloatingInside",
       robot({.b = "<link name=\"b\"/><link name=\"c\"/>",
              .j = between("j", "a", "b"),
              .more =
                  R"(<joint name="k" type="floating"><parent link="b"/><child link="c"/></joint>)"
                  "\n"}),
       "r.urdf:6: joint k is floating, but b is not an empty root link that carries nothing else; "
       "a floating joint ties the whole robot to the world, or is not understood"},
      {"FloatingFromMassiveWorld",
       robot(
           {.a =
                R"(<link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>)",
            .j = R"(<joint name="j" type="floating"><parent link="a"/><child link="b"/></joint>)"}),
       "r.urdf:4: joint j is floating, but a is not an empty root link that carries nothing else; "
       "a floating joint ties the whole robot to the world, or is not understood"},
      {"NoParent", robot({.j = R"(<joint name="j" type="fixed"><child link="b"/></joint>)"}),
       "r.urdf:4: <joint> has no <parent>; write <parent link=\"...\"/>"},
      {"NoChild", robot({.j = R"(<joint name="j" type="fixed"><parent link="a"/></joint>)"}),
       "r.urdf:4: <joint> has no <child>; write <child link=\"...\"/>"},
      {"ZeroAxis", joint("revolute", "\n<axis xyz=\"0 0 0\"/>"),
       "r.urdf:6: the axis of joint j is zero; write a direction such as \"0 0 1\""},
      {"AxisOfTwo", joint("revolute", "\n<axis xyz=\"0 1\"/>"),
       "r.urdf:6: xyz of <axis> has 2 numbers (\"0 1\"); write three, with blanks between them"},
      {"Mimic", joint("revolute", "<axis xyz=\"0 0 1\"/><mimic joint=\"k\"/>"),
       "r.urdf:4: joint j mimics k, a coupling that is not modelled; make it fixed in the URDF, or "
       "remove <mimic> if this joint moves on its own"},
      {"TwoOrigins", joint("revolute", "\n<origin/>\n<origin/>"),
       "r.urdf:7: a second <origin> in <joint>; keep one"},
      {"LimitsCrossed",
       joint("revolute",
             "\n<axis xyz=\"0 0 1\"/>\n<limit lower=\"1\" upper=\"-1\" effort=\"1\" "
             "velocity=\"1\"/>"),
       "r.urdf:7: joint j: lower limit 1 is above the upper limit -1; swap them"},
      {"LimitNan",
       joint("revolute",
             "\n<axis xyz=\"0 0 1\"/>\n<limit lower=\"nan\" upper=\"1\" effort=\"1\" "
             "velocity=\"1\"/>"),
       "r.urdf:7: lower of <limit> is not a finite number (\"nan\"); write a finite decimal "
       "number, or leave the attribute out"},
      {"LimitInfinite",
       joint("prismatic",
             "\n<axis xyz=\"0 0 1\"/>\n<limit lower=\"-inf\" upper=\"1\" effort=\"1\" "
             "velocity=\"1\"/>"),
       "r.urdf:7: lower of <limit> is not a finite number (\"-inf\"); write a finite decimal "
       "number, or leave the attribute out"},
      {"NegativeEffort",
       joint("revolute", "\n<axis xyz=\"0 0 1\"/>\n<limit effort=\"-3\" velocity=\"1\"/>"),
       "r.urdf:7: joint j: effort limit -3; N m, above 0"},
      {"NegativeVelocity",
       joint("revolute", "\n<axis xyz=\"0 0 1\"/>\n<limit effort=\"3\" velocity=\"-1\"/>"),
       "r.urdf:7: joint j: velocity limit -1; rad/s, above 0"},
      {"CollisionWithoutGeometry", robot({.a = "<link name=\"a\">\n<collision/></link>"}),
       "r.urdf:3: <collision> has no <geometry>; write <geometry> with one shape in it"},
      {"BoxWithoutSize", collision("<box/>"),
       "r.urdf:3: <box> has no size, or a negative one; write size=\"x y z\" in metres"},
      {"NegativeBox", collision("<box size=\"1 -1 1\"/>"),
       "r.urdf:3: <box> has no size, or a negative one; write size=\"x y z\" in metres"},
      {"CylinderWithoutLength", collision("<cylinder radius=\"1\"/>"),
       "r.urdf:3: <cylinder> has no attribute \"length\"; write it, also where it is zero"},
      {"NegativeSphere", collision("<sphere radius=\"-1\"/>"),
       "r.urdf:3: radius of <sphere> is negative (-1); write a length in metres"},
      {"MeshWithoutFile", collision("<mesh/>"),
       "r.urdf:3: <mesh> has no attribute \"filename\"; name it"},
  };
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, UrdfRefusals, testing::Range<std::size_t>(0, cases().size()),
                         [](const auto& i) { return std::string(cases()[i.param].what); });

}  // namespace
}  // namespace shapeid
