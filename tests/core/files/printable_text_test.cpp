#include "canyon/core/printable_text.h"

#include <gtest/gtest.h>

#include "canyon/core/result.h"

namespace canyon {
namespace {

TEST(PrintableText, OwnTextsComeOutUnchanged) {
  for (const char* text : {"", "500 is out of range", "M\xc3\xbcnchen, 30 \xe2\x82\xac, \xf0\x9f\x9b\xb0", "a  b "})
    EXPECT_EQ(printable_text(text), text);
}

TEST(PrintableText, ControlCharactersAndBytesThatAreNoUtf8BecomeNumbers) {
  EXPECT_EQ(printable_text("a\nb\tc\x1b[31m\x7f"), "a\\x0ab\\x09c\\x1b[31m\\x7f");
  EXPECT_EQ(printable_text(std::string_view("\0x", 2)), "\\x00x");
  // A lone continuation, a character cut short, an overlong slash, a surrogate, beyond U+10FFFF, a control of Latin-1.
  EXPECT_EQ(printable_text("\x80|\xe2\x82|\xc0\xaf|\xed\xa0\x80|\xf4\x90\x80\x80|\xc2\x85"),
            "\\x80|\\xe2\\x82|\\xc0\\xaf|\\xed\\xa0\\x80|\\xf4\\x90\\x80\\x80|\\xc2\\x85");
}

TEST(PrintableText, LongWordsAndLongTextsLoseTheirMiddle) {
  EXPECT_EQ(printable_text(std::string(120, 'a')), std::string(120, 'a'));
  EXPECT_EQ(printable_text("x " + std::string(121, 'a')), "x " + std::string(60, 'a') + "..." + std::string(40, 'a'));
  EXPECT_LT(printable_text(std::string(5'000'000, '[')).size(), 120u);
  std::string words;
  for (int k = 0; k < 1000; ++k) words += "word ";
  EXPECT_EQ(printable_text(words).size(), 700u + 3u + 250u);
  // Never inside a character: 60 bytes are not whole characters of three bytes after one of one.
  std::string wide = "a";
  for (int k = 0; k < 60; ++k) wide += "\xe2\x82\xac";
  EXPECT_EQ(escaped_text(printable_text(wide)), printable_text(wide));
}

// 2026-11-22: a field of a damaged file was quoted as it was: line ends made several lines of an error, escape
// sequences reached the terminal, and a line of a megabyte was shown whole.
TEST(PrintableText, AnErrorIsOneLine) {
  const Error error{.file = "a\nb.csv", .line = 3, .key = "x\x1b", .what = "\"1\r\n2\"", .expected = "a number"};
  EXPECT_EQ(error.str(), "a\\x0ab.csv:3: x\\x1b: \"1\\x0d\\x0a2\", expected a number");
  const Error lengthy{.file = "a.csv", .what = "\"" + std::string(1'000'000, '9') + "\"", .expected = "a number"};
  EXPECT_LT(lengthy.str().size(), 200u);
}

}  // namespace
}  // namespace canyon
