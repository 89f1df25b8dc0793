#include "canyon/report/format.h"

#include <cmath>

#include <gtest/gtest.h>

namespace canyon::report {
namespace {

// U+2212 minus, U+2013 dash, U+202F thin no-break space, U+00A0 no-break space, U+FFFD replacement.
TEST(Format, ShowsSignificantDigits) {
  EXPECT_EQ(show_number(0.12345), "0.123");
  EXPECT_EQ(show_number(1.0), "1.00");
  EXPECT_EQ(show_number(12.345), "12.3");
  EXPECT_EQ(show_number(1234.5), "1234");  // half to even, as the decimal expansion is exact
  EXPECT_EQ(show_number(9.996), "10.0");
  EXPECT_EQ(show_number(0.0), "0");
  EXPECT_EQ(show_number(-4.31),
            "\xE2\x88\x92"
            "4.31");
  EXPECT_EQ(show_number(12345.6),
            "12\xE2\x80\xAF"
            "346");
  EXPECT_EQ(show_number(1.5e-7),
            "1.50e\xE2\x88\x92"
            "7");
  EXPECT_EQ(show_number(2.5e12), "2.50e12");
  EXPECT_EQ(show_number(0.5, 1), "0.5");
}

TEST(Format, ShowsUndefinedAsADash) {
  EXPECT_EQ(show_number(std::nan("")), "\xE2\x80\x93");
  EXPECT_EQ(show_quantity(std::nan(""), "m"), "\xE2\x80\x93");
  EXPECT_EQ(show_share(std::nan("")), "\xE2\x80\x93");
  EXPECT_EQ(show_count(INFINITY), "\xE2\x80\x93");
}

TEST(Format, ShowsUnitsSharesAndCounts) {
  EXPECT_EQ(show_quantity(4.31, "m"), "4.31\xC2\xA0m");
  EXPECT_EQ(show_quantity(1.2, "\xC2\xB0", 2), "1.2\xC2\xB0");
  EXPECT_EQ(show_share(0.1234), "12.3\xC2\xA0%");
  EXPECT_EQ(show_share(0.0), "0\xC2\xA0%");
  EXPECT_EQ(show_share(1.0), "100\xC2\xA0%");
  EXPECT_EQ(show_share(0.0004), "0.04\xC2\xA0%");
  EXPECT_EQ(show_count(1234567),
            "1\xE2\x80\xAF"
            "234\xE2\x80\xAF"
            "567");
  EXPECT_EQ(count_of(1, "fix", "fixes"),
            "1\xC2\xA0"
            "fix");
  EXPECT_EQ(count_of(4, "fix", "fixes"),
            "4\xC2\xA0"
            "fixes");
}

TEST(Format, FixedNumbersAreShortAndHaveNoExponent) {
  EXPECT_EQ(fixed(1.50, 2), "1.5");
  EXPECT_EQ(fixed(100, 2), "100");
  EXPECT_EQ(fixed(-0.001, 2), "0");
  EXPECT_EQ(fixed(1e20, 1), "100000000000000000000");
  EXPECT_EQ(fixed(0.05, 3), "0.05");
}

TEST(Format, EscapesMarkup) {
  EXPECT_EQ(escape_html("<a href=\"x\">&'</a>"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;&lt;/a&gt;");
  EXPECT_EQ(escape_html("fa\xC3\xA7"
                        "ade \xF0\x9F\x9A\x97"),
            "fa\xC3\xA7"
            "ade \xF0\x9F\x9A\x97");
}

TEST(Format, ReplacesWhatIsNoText) {
  EXPECT_EQ(escape_html(std::string("a\0b", 3)),
            "a\xEF\xBF\xBD"
            "b");
  EXPECT_EQ(escape_html("a\xFF"
                        "b"),
            "a\xEF\xBF\xBD"
            "b");
  EXPECT_EQ(escape_html("\xC3"), "\xEF\xBF\xBD");                  // cut off
  EXPECT_EQ(escape_html("\xC0\xBC"), "\xEF\xBF\xBD\xEF\xBF\xBD");  // an overlong '<' must not come through
  EXPECT_EQ(escape_html("\xED\xA0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");  // a surrogate
}

}  // namespace
}  // namespace canyon::report
