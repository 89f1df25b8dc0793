// What the measurements tell of each state over time: read from summary.json, and drawn.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/report/sections/filter_verdict.h"

namespace canyon::report {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kVerdictSummary = R"({"verdict": ["consistent"], "evidence": {"tests": 1, "states": [
  {"block": "attitude", "name": "roll", "share": 0.1, "halved_after_s": 5.0},
  {"block": "attitude", "name": "yaw", "share": 0.4, "halved_after_s": 20.0},
  {"block": "antenna_lever", "name": "antenna_lever x", "share": 0.9, "halved_after_s": null}],
  "observability": {"t_s": [0, 10, 20],
    "states": {"roll": [1, 0.2, 0.1], "yaw": [1, 0.7, 0.4], "antenna_lever x": [1, 1, 0.9]}}}})";

FilterVerdict read(const std::string& text, std::optional<Error>& error) {
  const auto file = JsonFile::parse(text, "summary.json");
  EXPECT_TRUE(file.ok());
  return read_filter_verdict(JsonFields(&file->root(), *file, "", error));
}

TEST(ObservabilityChart, HasAPanelForEachBlockAndALineForEachState) {
  std::optional<Error> error;
  const FilterVerdict verdict = read(kVerdictSummary, error);
  ASSERT_FALSE(error.has_value()) << error->str();
  EXPECT_THAT(verdict.looked_s, ElementsAre(0.0, 10.0, 20.0));
  ASSERT_EQ(verdict.states.size(), 3U);
  EXPECT_THAT(verdict.states[1].shares, ElementsAre(1.0, 0.7, 0.4));
  const std::string chart = observability_chart(verdict, 0);
  for (const char* text : {"attitude", "antenna lever", "yaw", "roll", "over time"})
    EXPECT_THAT(chart, HasSubstr(text));
  EXPECT_THAT(chart, Not(HasSubstr("http")));  // nothing is fetched
}

TEST(ObservabilityChart, NamesStatesWithinTheirBlock) {
  const FilterVerdict verdict{
      .lines = {},
      .rows = {},
      .states = {{"position", "east position", 0.5, 1.0, {1.0, 0.5}}, {"position", "height", 0.6, 2.0, {1.0, 0.6}}},
      .looked_s = {0.0, 1.0}};
  const std::string chart = observability_chart(verdict, 0);
  EXPECT_THAT(chart, HasSubstr(">east<"));
  EXPECT_THAT(chart, HasSubstr(">height<"));
}

TEST(ObservabilityChart, IsNotThereWhereNothingWasLookedAt) {
  std::optional<Error> error;
  EXPECT_EQ(observability_chart(read(R"({"evidence": {"states": []}})", error), 0), "");
  EXPECT_EQ(observability_chart(read(R"({"verdict": ["consistent"]})", error), 0), "");
  EXPECT_FALSE(error.has_value());
}

TEST(ObservabilityChart, ASeriesOfAnotherLengthIsAMistakeWithItsLine) {
  std::optional<Error> error;
  read(
      "{\"evidence\": {\"states\": [{\"block\": \"b\", \"name\": \"roll\"}],\n\"observability\": {\"t_s\": [0, 1],\n"
      "\"states\": {\"roll\": [1]}}}}",
      error);
  ASSERT_TRUE(error.has_value());
  EXPECT_THAT(error->str(), HasSubstr("summary.json:3: evidence.observability.states.roll"));
}

}  // namespace
}  // namespace canyon::report
