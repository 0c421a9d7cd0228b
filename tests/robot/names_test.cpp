// Which bytes a name may hold: UTF-8 as RFC 3629 has it, to the last code point and no further.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace shapeid
