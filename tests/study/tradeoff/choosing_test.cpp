// The inverse question: what is asked, and how combinations are ranked.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/study/tradeoff/choosing/choose.h"
#include "canyon/study/tradeoff/choosing/combinations.h"

namespace canyon::study {
namespace {

using ::testing::HasSubstr;

TEST(Combinations, AreTheFrontOfAllThatThereAre) {
  const RandomStream stream(3, "test");
  std::vector<std::vector<Option>> keys(5);
  for (std::uint32_t k = 0; k < keys.size(); ++k) {
    keys[k].push_back({});
    for (std::uint32_t i = 0; i < 3; ++i) keys[k].push_back({-stream.uniform(k, i, 0), stream.uniform(k, i, 1)});
  }
  // Every one of the 4^5, by counting.
  std::vector<Combination> all;
  for (int n = 0; n < 1024; ++n) {
    Combination one;
    for (int k = 0, rest = n; k < 5; ++k, rest /= 4) {
      const Option& option = keys[static_cast<std::size_t>(k)][static_cast<std::size_t>(rest % 4)];
      one.cpu_s += option.cpu_s;
      one.change += option.change;
    }
    all.push_back(one);
  }
  const auto front = best_combinations(keys);
  for (const Combination& one : all)
    EXPECT_TRUE(std::any_of(front.begin(), front.end(), [&](const Combination& f) {
      return f.cpu_s <= one.cpu_s + 1e-12 && f.change <= one.change + 1e-12;  // sums of five in another order
    }));
  for (std::size_t i = 1; i < front.size(); ++i) {
    EXPECT_GT(front[i].cpu_s, front[i - 1].cpu_s);
    EXPECT_LT(front[i].change, front[i - 1].change);
  }
}

TEST(Question, IsReadOrItsMistakeTold) {
  const auto none = read_question("", std::nullopt, "position_error_rms_m");
  ASSERT_TRUE(none);
  EXPECT_FALSE(none->has_value());
  const auto asked = read_question("map_error_rms_m=0.01", std::nullopt, "");
  ASSERT_TRUE(asked) << asked.error().str();
  EXPECT_EQ((*asked)->figure, find_figure("map_error_rms_m"));
  EXPECT_EQ((*asked)->tolerance, 0.01);
  const auto mistake = [](const std::string& tolerance, std::optional<double> budget_cpu_s, const std::string& figure) {
    const auto read = read_question(tolerance, budget_cpu_s, figure);
    return read ? std::string("no mistake") : read.error().str();
  };
  EXPECT_THAT(mistake("position_rms=1", {}, ""), HasSubstr("--tolerance: \"position_rms\" is no figure"));
  EXPECT_EQ(mistake("position_error_rms_m=0", {}, ""),
            "--tolerance: position_error_rms_m: \"0\", expected a number above 0");
  EXPECT_EQ(mistake("position_error_rms_m=-1", {}, ""),
            "--tolerance: position_error_rms_m: \"-1\", expected a number above 0");
  EXPECT_EQ(mistake("position_error_rms_m", {}, ""),
            "--tolerance: \"position_error_rms_m\" has no value, expected FIGURE=VALUE, as position_error_rms_m=0.05");
  EXPECT_THAT(mistake("cpu_s=1", {}, ""), HasSubstr("depends on the machine"));
  EXPECT_THAT(mistake("map_error_rms_m=1", 1.0, ""), HasSubstr("stands beside --tolerance"));
  EXPECT_THAT(mistake("", -1.0, "map_error_rms_m"), HasSubstr("expected a positive number"));
  EXPECT_THAT(mistake("", 1.0, "map_rms"), HasSubstr("--figure: \"map_rms\" is no figure"));
}

// 2026-11-22: a second [fidelity.tradeoff] was appended, and `--fidelity tradeoff` became the base of itself.
TEST(Question, AMissionThatHasAnAnswerIsRefusedBeforeAnythingIsMeasured) {
  const auto file =
      mission::MissionFile::parse("base = \"vicksburg\"\n[fidelity.tradeoff]\nbase = \"low\"\n", "my.toml");
  ASSERT_TRUE(file) << file.error().str();
  const auto status = check_writable("my.toml", *file, "answer.toml");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().str(),
            "--write: my.toml has a fidelity \"tradeoff\" already, expected a mission file without "
            "[fidelity.tradeoff]");
  const auto without = mission::MissionFile::parse("base = \"vicksburg\"\n", "my.toml");
  EXPECT_TRUE(check_writable("my.toml", *without, "answer.toml").ok());
  EXPECT_FALSE(check_writable("my.toml", *without, "elsewhere/answer.toml").ok());
  EXPECT_TRUE(check_writable("vicksburg", *without, "elsewhere/answer.toml").ok());
}

TEST(Question, TheAnswersMissionIsReadAgain) {
  Chosen chosen;
  chosen.found = true;
  chosen.settings = {{"gnss.paths", "specular1"}, {"registration.leaf_m", "1"}, {"gnss.diffraction", "none"}};
  const auto text = mission_with(chosen, "high", "", "answer.toml");
  ASSERT_TRUE(text) << text.error().str();
  EXPECT_EQ(*mission_with(chosen, "high", "vicksburg", "answer.toml"), *text);
  const auto file = mission::MissionFile::parse(*text, "answer.toml");
  ASSERT_TRUE(file) << file.error().str();
  const auto config = file->resolve("tradeoff");
  ASSERT_TRUE(config) << config.error().str();
  EXPECT_EQ(config->gnss.propagation.paths.name, "specular1");
  EXPECT_EQ(config->gnss.propagation.diffraction.name, "none");
}

}  // namespace
}  // namespace canyon::study
