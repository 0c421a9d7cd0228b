// Which texts are numbers, wherever a file holds them.
#include "shapeid/models/number.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace shapeid {
namespace {

TEST(Numbers, MayHaveASignBlanksAndAnExponent) {
  for (const auto& [text, value] : std::vector<std::pair<const char*, double>>{{"1", 1.0},
                                                                               {"+1", 1.0},
                                                                               {"-1", -1.0},
                                                                               {"+.5", 0.5},
                                                                               {"-0.25", -0.25},
                                                                               {" \t2.5\r\n", 2.5},
                                                                               {"+1e-3", 1e-3},
                                                                               {"4E2", 400.0},
                                                                               {"0", 0.0}}) {
    EXPECT_EQ(parse_number(text), value) << text;
  }
}

TEST(Numbers, AreRefusedWhereAnotherReaderMightGuess) {
  for (const char* text : {"", " ", "+", "-", "+-1", "++1", "-+1", "--1", "1,5", "1 2", "0x1p3",
                           "1e", "nan", "inf", "-inf", "1e999", "${mass}", "1kg"}) {
    EXPECT_EQ(parse_number(text), std::nullopt) << text;
  }
}

TEST(Numbers, WhatIsWrongIsSaid) {
  EXPECT_EQ(why_no_number(" "), "is empty");
  EXPECT_EQ(why_no_number("${m}"), "is a xacro expression (\"${m}\"); expand the file first");
  EXPECT_EQ(why_no_number("1e999"), "does not fit into a double (\"1e999\")");
  EXPECT_EQ(why_no_number("inf"), "is not a finite number (\"inf\")");
  EXPECT_EQ(why_no_number("1,5"), "is not a number (\"1,5\": decimals take a point, not a comma)");
  EXPECT_EQ(why_no_number("+-1"), "is not a number (\"+-1\")");
}

}  // namespace
}  // namespace shapeid
