// `canyon reproduce` as it is typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps::testing {
namespace {

using ::testing::HasSubstr;

class ReproduceTest : public CommandLineTest {};

TEST_F(ReproduceTest, WritesThePageAndTheNumbers) {
  ASSERT_EQ(canyon("reproduce --draws 1 --out paper"), 0) << read("stderr");
  EXPECT_THAT(read("stdout"), HasSubstr("Table 1 and Fig. 1"));
  EXPECT_THAT(read("stdout"),
              HasSubstr("satellites: the built-in constellation of 24 GPS slots, from 2010-11-17T13:00:00"));
  EXPECT_THAT(read("paper/report.html"), HasSubstr("<h1>Durst &amp; Goodin 2012, beside ours</h1>"));
  EXPECT_THAT(read("paper/summary.json"), HasSubstr("\"name\": \"table_2\""));
}

TEST_F(ReproduceTest, MistakesAreOneLine) {
  EXPECT_EQ(canyon("reproduce --draws 0 --out paper"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("--draws"));
  EXPECT_EQ(canyon("reproduce --nav nothing.10n --out paper"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("nothing.10n"));
  EXPECT_EQ(canyon("reproduce --start soon --out paper"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("soon"));
  EXPECT_FALSE(std::filesystem::exists(path("paper"))) << "nothing is left";
}

}  // namespace
}  // namespace canyon::apps::testing
