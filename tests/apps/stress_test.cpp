#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps::testing {
namespace {

using ::testing::HasSubstr;

class StressTest : public CommandLineTest {};

TEST_F(StressTest, RunsTheCasesThatAreNamed) {
  ASSERT_EQ(canyon("stress gauss_markov --json"), 0) << read("stderr");
  const auto json = nlohmann::json::parse(read("stdout"));
  ASSERT_GT(json["cases"].size(), 3U);
  for (const auto& row : json["cases"]) {
    EXPECT_EQ(row["pass"], true) << row;
    EXPECT_EQ(row["name"].get<std::string>().rfind("gauss_markov/", 0), 0U);
    for (const char* key : {"group", "mechanism", "figure", "bound", "unit", "seconds"})
      EXPECT_TRUE(row.contains(key)) << key;
  }
}

TEST_F(StressTest, BadInputIsOneLine) {
  EXPECT_EQ(canyon("stress gauss_markow"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("case: \"gauss_markow\" is unknown, expected a case, or all of a subject: "));
  EXPECT_THAT(read("stderr"), HasSubstr("; nearest is \"gauss_markov\"\n"));
  EXPECT_EQ(canyon("stress --group stif"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("--group: unknown name \"stif\""));
  EXPECT_EQ(canyon("stress none.toml"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("none.toml: "));
  EXPECT_EQ(canyon("stress mission.toml --budget-s 0"), 2);
  EXPECT_THAT(read("stderr"), HasSubstr("--budget-s: "));
  EXPECT_EQ(canyon("stress mission.toml gauss_markov"), 2);
  EXPECT_EQ(read("stderr"), "command line: a mission and more, expected one mission, or cases\n");
}

// Some seconds of it: seeded, so that the same keys are tried; what is left is told.
TEST_F(StressTest, AMissionsKeysAreTriedForAsLongAsThereIsTime) {
  ASSERT_EQ(canyon("stress mission.toml --budget-s 8 --json"), 0) << read("stdout");
  const auto json = nlohmann::json::parse(read("stdout"));
  EXPECT_GT(json["values_tried"].get<int>() + json["pairs_tried"].get<int>(), 0);
  EXPECT_GT(json["not_tried"].get<int>(), 500);
  EXPECT_TRUE(json["failures"].empty());
  EXPECT_THAT(leftovers(), ::testing::IsEmpty());
}

// With one guard taken out of it, a program is found out: tests/study/stress/sweep_test.cpp.

}  // namespace
}  // namespace canyon::apps::testing
