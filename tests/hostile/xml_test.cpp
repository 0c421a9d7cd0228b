// URDF files made to exhaust a reader: entities, depth, sizes, numbers at the ends of double.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/hostile/refused.hpp"

namespace shapeid {
namespace {

using test::refusal, test::repeated, test::says;

std::string refusal_of_xml(const std::string& text) {
  return refusal([&] { static_cast<void>(parse_urdf(text, "r.urdf")); });
}

/// A chain of `links` links, tied by joints of one type.
std::string chain(int links, const std::string& type) {
  std::string text = "<robot name=\"chain\">\n";
  for (int i = 0; i < links; ++i) {
    text += fmt::format(
        "<link name=\"l{}\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" "
        "iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link>\n",
        i);
    if (i == 0) continue;
    text += fmt::format(
        "<joint name=\"j{}\" type=\"{}\"><origin xyz=\"0 0 0.1\"/><parent link=\"l{}\"/><child "
        "link=\"l{}\"/><axis xyz=\"0 1 0\"/></joint>\n",
        i, type, i - 1, i);
  }
  return text + "</robot>\n";
}

// A thousand million laughs, if entities were expanded.
TEST(HostileXml, EntityBomb) {
  std::string text = "<?xml version=\"1.0\"?>\n<!DOCTYPE robot [\n<!ENTITY a0 \"ha\">\n";
  for (int i = 1; i < 10; ++i) {
    text += fmt::format("<!ENTITY a{} \"{}\">\n", i, repeated(fmt::format("&a{};", i - 1), 10));
  }
  text += "]>\n<robot name=\"r\"><link name=\"&a9;\"/></robot>";
  EXPECT_EQ(
      refusal_of_xml(text),
      "r.urdf:2: a document type or entity declaration (\"<!\"); a URDF needs none: remove it");
}

// Without a declaration an entity is a text like any other, and no file is fetched.
TEST(HostileXml, UnknownEntitiesStayAsTheyAre) {
  const Robot robot = parse_urdf("<robot name=\"r\"><link name=\"&passwd;\"/></robot>", "r").robot;
  EXPECT_EQ(robot.links[0].name, "&passwd;");
}

TEST(HostileXml, AHundredThousandDeep) {
  constexpr std::size_t deep = 100000;
  const std::string text =
      "<robot name=\"r\">" + repeated("<a>", deep) + repeated("</a>", deep) + "</robot>";
  EXPECT_TRUE(says(refusal_of_xml(text), "nested more than 100 deep"));
  EXPECT_TRUE(says(refusal_of_xml("<robot name=\"r\">" + repeated("<a>", deep)), "r.urdf:1"));
}

// As many elements, attributes and comments as a file may hold: read in seconds or refused.
TEST(HostileXml, SixteenMegabytesOfAnything) {
  constexpr std::size_t size = (std::size_t{1} << 24) - 100;
  for (const std::string part : {"<a/>", "<!--x-->", "x ", "<collision/>"}) {
    const std::string text = "<robot name=\"r\"><link name=\"a\">" +
                             repeated(part, size / part.size() - 1) + "</link></robot>";
    const std::string message = refusal_of_xml(text);
    EXPECT_TRUE(message == "accepted" || says(message, "r.urdf")) << message;
  }
}

TEST(HostileXml, ThousandsOfLinks) {
  EXPECT_EQ(parse_urdf(chain(5000, "fixed"), "r").robot.links.at(0).inertia.mass(), 5000.0);
  EXPECT_EQ(parse_urdf(chain(1000, "revolute"), "r").robot.link_count(), 1000);
  EXPECT_EQ(refusal_of_xml(chain(5000, "revolute")),
            "r.urdf:2002: more than 1000 links that move; write joints that do not move as fixed");
}

TEST(HostileXml, CyclesOfThousands) {
  std::string text = chain(3000, "revolute");
  text.insert(
      text.find("</robot>"),
      "<joint name=\"back\" type=\"fixed\"><parent link=\"l2999\"/><child link=\"l0\"/></joint>");
  EXPECT_TRUE(says(refusal_of_xml(text), "the joints form a cycle"));
}

std::string with_mass(const std::string& mass) {
  return "<robot name=\"r\"><link name=\"a\"><inertial><mass value=\"" + mass +
         "\"/><inertia ixx=\"0\" ixy=\"0\" ixz=\"0\" iyy=\"0\" iyz=\"0\" "
         "izz=\"0\"/></inertial></link>"
         "</robot>";
}

TEST(HostileXml, NumbersAtTheEndsOfDouble) {
  EXPECT_EQ(parse_urdf(with_mass("5e-324"), "r").robot.links[0].inertia.mass(), 5e-324);
  EXPECT_TRUE(says(refusal_of_xml(with_mass("1e400")), "does not fit into a double"));
  EXPECT_TRUE(says(refusal_of_xml(with_mass("1e-400")), "does not fit into a double"));
  EXPECT_TRUE(says(refusal_of_xml(with_mass("1e308")), "nothing here exceeds 1e+09"));
  EXPECT_TRUE(says(refusal_of_xml(with_mass("INF")), "is not a finite number"));
  EXPECT_TRUE(says(refusal_of_xml(with_mass("-nan(0x1)")), "is not a finite number"));
  EXPECT_TRUE(says(refusal_of_xml(with_mass(repeated("1", 100000))), "does not fit into a double"));
}

TEST(HostileXml, ByteOrderMarkAndCarriageReturns) {
  std::string text = chain(3, "revolute");
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(parse_urdf(windows, "r").robot.link_count(), 3);
  const std::string utf16("\xFF\xFE<\0r\0o\0", 8);
  EXPECT_TRUE(says(refusal_of_xml(utf16), "r.urdf"));
}

// A name of a megabyte, and one that would clear the screen, are quoted so that neither does harm.
TEST(HostileXml, NamesInMessages) {
  const std::string name = repeated("long ", 200000) + "name";
  const std::string twice = "<link name=\"" + name + "\"/>";
  EXPECT_TRUE(
      says(refusal_of_xml("<robot name=\"r\">" + twice + twice + "</robot>"), "a second link"));
  EXPECT_TRUE(
      says(refusal_of_xml("<robot name=\"r\"><link name=\"a\"><inertial><mass value=\"\x1b[2J\"/>"
                          "<inertia/></inertial></link></robot>"),
           "\\x1b[2J"));
}

}  // namespace
}  // namespace shapeid
