// JSON files made to exhaust a reader: depth, sizes that are only stated, keys with control codes.
#include <gtest/gtest.h>

#include <string>

#include "shapeid/models/problem_json.hpp"
#include "shapeid/models/shape_json.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/proofs/certificate/certificate_json.hpp"
#include "shapeid/tests/hostile/refused.hpp"

namespace shapeid {
namespace {

using test::refusal, test::repeated, test::says;

std::string problem(const std::string& text) {
  return refusal([&] { static_cast<void>(stated_problem_from_json(text, "p.json")); });
}

std::string certificate_of(const std::string& text) {
  return refusal(
      [&] { static_cast<void>(certificate::certificate_from_json(text, "c.json", {})); });
}

TEST(HostileJson, AMillionBrackets) {
  constexpr std::size_t deep = 1000000;
  const std::string closed = repeated("[", deep) + repeated("]", deep);
  for (const std::string& text :
       {closed, repeated("[", deep), repeated("{\"a\":", deep),
        "{\"format\":\"shapeid-certificate-2\",\"evidence\":{},\"claim\":{\"floor\":" + closed +
            "}}"}) {
    EXPECT_TRUE(says(problem(text), "p.json: nested deeper than 64"));
    EXPECT_TRUE(says(certificate_of(text), "c.json: nested deeper than 64"));
  }
}

TEST(HostileJson, SixtyFourLevelsAreTaken) {
  constexpr std::size_t deepest = 64;
  const auto nested = [](std::size_t depth) {
    return refusal([&] {
      static_cast<void>(parse_json(repeated("[", depth) + repeated("]", depth), {"a.json", ""}));
    });
  };
  EXPECT_EQ(nested(deepest), "accepted");
  EXPECT_TRUE(says(nested(deepest + 1), "a.json: nested deeper than 64"));
}

// A hundred thousand columns in each of a hundred thousand rows would be 80 GB, if it were
// believed.
TEST(HostileJson, SizesThatAreOnlyStated) {
  std::string rows = "[[]";
  rows += repeated(",[]", 99999) + "]";
  const std::string text = "{\"format\":\"shapeid-problem-1\",\"free_links\":10000,\"Y\":" + rows +
                           ",\"F\":[],\"W\":[],\"U\":" + rows +
                           ",\"V\":[],\"lambda\":0,\"mass_bound\":0}";
  EXPECT_EQ(problem(text), "p.json, key Y: row 0 has 0 numbers; every row has 100000");
}

TEST(HostileJson, NumbersAtTheEndsOfDouble) {
  const auto with_lambda = [](const std::string& lambda) {
    return problem(
        "{\"format\":\"shapeid-problem-1\",\"free_links\":0,\"Y\":[],\"F\":[],\"W\":[],\"U\":[],"
        "\"V\":[],\"mass_bound\":0,\"lambda\":" +
        lambda + "}");
  };
  EXPECT_EQ(with_lambda("5e-324"), "accepted");
  EXPECT_EQ(with_lambda("1e308"), "accepted");
  for (const char* bad : {"1e400", "NaN", "Infinity", "nan", "\"0x1p+2000\"", "\"0x1p-3 \"", "1e",
                          "+1", "0x10", "1,5", "null", "true", "[1]"}) {
    EXPECT_TRUE(says(with_lambda(bad), "p.json")) << bad;
  }
}

TEST(HostileJson, ListsWhereObjectsBelong) {
  for (const char* other : {"[]", "[1]", "1", "null", "\"a\""}) {
    EXPECT_TRUE(says(problem(other), "p.json: has no or another format")) << other;
    const std::string claim =
        std::string("{\"format\":\"shapeid-certificate-2\",\"claim\":") + other;
    EXPECT_TRUE(says(certificate_of(claim + ",\"evidence\":{}}"), "key claim: not an object"))
        << other;
    const std::string problem_with_columns =
        "{\"format\":\"shapeid-problem-1\",\"free_links\":0,\"Y\":[],\"F\":[],\"W\":[],\"U\":[],"
        "\"V\":[],\"mass_bound\":0,\"lambda\":0,\"columns\":";
    EXPECT_TRUE(says(problem(problem_with_columns + other + "}"), "key columns: not an object"))
        << other;
  }
}

TEST(HostileJson, FacesThatAreNoTriangles) {
  const auto with_face = [](const std::string& face) {
    return refusal([&] {
      const JsonSource source{"p.json", "docs/formats/problem.md"};
      const std::string shape =
          "{\"kind\":\"polyhedron\",\"link\":0,\"convex\":true,\"vertices\":[[0,0,0],[1,0,0],[0,1,"
          "0],[0,0,1]],"
          "\"faces\":[[0,2,1],[0,1,3],[0,3,2]," +
          face + "]}";
      static_cast<void>(shape_from_json(parse_json(shape, source), "shape", source));
    });
  };
  EXPECT_EQ(with_face("[1,2,3]"), "accepted");
  for (const char* bad : {"[]", "[1,2]", "[1,2,3,0]", "{\"a\":1,\"b\":2,\"c\":3}", "1", "null"}) {
    EXPECT_EQ(with_face(bad), "p.json, key faces: not three numbers; indices of three vertices")
        << bad;
  }
  for (const char* bad : {"[1,2,4]", "[1,2,-1]", "[1,2,0.5]", "[1,2,\"a\"]"}) {
    EXPECT_TRUE(says(with_face(bad), "p.json, key faces: ")) << bad;
  }
}

TEST(HostileJson, KeysThatNoTerminalShouldSee) {
  EXPECT_EQ(problem("{\"format\":\"shapeid-problem-1\",\"a\\u001b[2J\\nb\":1}"),
            "p.json, key a\\x1b[2J\\x0ab: unknown key; see docs/formats/problem.md");
  EXPECT_TRUE(
      says(problem("{\"format\":\"shapeid-problem-1\",\"" + repeated("k", 100000) + "\":1}"),
           "unknown key"));
}

TEST(HostileJson, TextThatIsNone) {
  for (const std::string& text :
       {std::string(), std::string("\0", 1), std::string("\xFF\xFE{\0}\0", 6),
        std::string("\xEF\xBB\xBF"), std::string("{} {}"), std::string("{\"format\":\"\xFF\"}"),
        std::string("// comment\n{}")}) {
    EXPECT_TRUE(says(problem(text), "p.json: ")) << text;
  }
}

}  // namespace
}  // namespace shapeid
