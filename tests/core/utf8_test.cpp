#include "core/utf8.h"

#include <gtest/gtest.h>

namespace canyon {
namespace {

TEST(Utf8, WhatIsValidStaysAsItIs) {
  for (const char* text : {"", "brick",
                           "Stra\xc3\x9f"
                           "e",
                           "\xe6\xb8\x8b\xe8\xb0\xb7", "\xf0\x9f\x8f\x99", "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf"})
    EXPECT_EQ(valid_utf8(text), text);
}

TEST(Utf8, EachByteThatIsNoneBecomesTheReplacementCharacter) {
  const std::string r = "\xef\xbf\xbd";
  EXPECT_EQ(valid_utf8("Stra\xdf"
                       "e"),
            "Stra" + r + "e");                               // Latin-1
  EXPECT_EQ(valid_utf8("\xc3"), r);                          // cut off
  EXPECT_EQ(valid_utf8("\xc0\xaf"), r + r);                  // overlong
  EXPECT_EQ(valid_utf8("\xe0\x80\xaf"), r + r + r);          // overlong
  EXPECT_EQ(valid_utf8("\xed\xa0\x80"), r + r + r);          // half of a surrogate pair
  EXPECT_EQ(valid_utf8("\xf4\x90\x80\x80"), r + r + r + r);  // beyond U+10FFFF
  EXPECT_EQ(valid_utf8(std::string_view("a\0b", 3)), std::string("a\0b", 3));
}

}  // namespace
}  // namespace canyon
