// Which bytes a name may hold: UTF-8 as RFC 3629 has it, to the last code point and no further.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "shapeid/models/text.hpp"

namespace shapeid {
namespace {

TEST(Names, HoldTheFirstAndTheLastCodePointOfEachLength) {
  for (const char* name :
       {"a", "\x7E", "\xC2\xA1", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xEE\x80\x80",
        "\xEF\xBF\xBD", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"}) {
    EXPECT_EQ(why_no_name(name), std::nullopt) << name;
  }
}

TEST(Names, HoldNothingElse) {
  const auto refused = {
      "\x80",              // a byte that follows, alone
      "\xC1\xBF",          // overlong
      "\xE0\x9F\xBF",      // overlong
      "\xF0\x8F\xBF\xBF",  // overlong
      "\xED\xA0\x80",      // half of a surrogate
      "\xF4\x90\x80\x80",  // beyond U+10FFFF
      "\xF5\x80\x80\x80",  // beyond U+10FFFF
      "\xC3",              // cut
      "\xE2\x82",          // cut
      "\xE2\x82x",         // a byte that does not follow
  };
  for (const char* name : refused) EXPECT_EQ(why_no_name(name), "is not UTF-8 text") << name;
}

// Messages quote files: whatever is there, one line of about the wanted length.
TEST(OneLine, CutsBetweenCharactersOnly) {
  EXPECT_EQ(one_line("abc", 3), "abc");
  EXPECT_EQ(one_line("abcd", 3), "abc...");
  EXPECT_EQ(one_line("a\nb\x7F\x1F", 20), "a\\x0ab\\x7f\\x1f");
  // Two, three and four bytes; the cut falls behind each of their bytes in turn.
  for (const std::string character : {"\xC3\xA4", "\xE2\x82\xAC", "\xF0\x9F\xA4\x96"}) {
    for (std::size_t most = 1; most <= character.size(); ++most) {
      EXPECT_EQ(one_line(character + "end", most), character + "...");
    }
  }
  // What looks like the inside of one character without end is cut as well.
  EXPECT_EQ(one_line(std::string(100, '\x80'), 10), fmt::format("{}...", std::string(13, '\x80')));
}

}  // namespace
}  // namespace shapeid
