#include "canyon/study/stress/sweep/sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include "canyon/core/files/files.h"
#include "canyon/mission/config/mission_config.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Small {
  double rate_hz = 1.0;
  std::int64_t count = 3;
  bool on = false;
  std::string model = "a", name = "x";
  std::vector<double> corner{0.0, 0.0};
};
void visit(FieldVisitor& f, Small& c) {
  f.number("rate_hz", c.rate_hz, {0.05, 20.0, -1.0}, "");
  f.integer("count", c.count, {0, 15}, "");
  f.flag("on", c.on, "");
  f.choice("model", c.model, {"a", "b"}, "");
  f.text("name", c.name, "");
  f.numbers("corner", c.corner, 2, {-5, 5}, "");
}

std::vector<SweptKey> keys() {
  Small small;
  return swept_keys([&small](FieldVisitor& f) { visit(f, small); });
}

TEST(SweptKeys, HaveEndsDecadesAndWhatStandsForNone) {
  const auto all = keys();
  ASSERT_EQ(all.size(), 5U);
  EXPECT_THAT(all[0].values, ElementsAre("-1", "0.05", "0.1", "1", "10", "20"));
  EXPECT_THAT(all[1].values, ElementsAre("0", "1", "10", "15"));
  EXPECT_THAT(all[2].values, ElementsAre("false", "true"));
  EXPECT_THAT(all[3].values, ElementsAre("\"a\"", "\"b\""));
  EXPECT_THAT(all[4].values.front(), "[-5,-5]");
  EXPECT_TRUE(all[4].numeric);
  EXPECT_FALSE(all[3].numeric);
}

TEST(SweptKeys, OfAMissionAreNearlyAll) {
  mission::MissionConfig config;
  const auto all = swept_keys([&config](FieldVisitor& f) { visit(f, config); });
  const auto numeric = std::count_if(all.begin(), all.end(), [](const SweptKey& key) { return key.numeric; });
  EXPECT_GE(numeric, 140);
}

TEST(SweepSettings, PairsAreOfTwoKeysAndTheSameForASeed) {
  SweepOptions options{.setup = {}, .seed = 7, .pairs = 200};
  const auto settings = sweep_settings(keys(), options);
  ASSERT_EQ(settings.size(), 6U + 4 + 2 + 2 + keys()[4].values.size() + 200);
  for (std::size_t i = settings.size() - 200; i < settings.size(); ++i) {
    ASSERT_EQ(settings[i].size(), 2U);
    EXPECT_NE(settings[i][0].first, settings[i][1].first);
  }
  EXPECT_EQ(settings, sweep_settings(keys(), options));
  options.seed = 8;
  EXPECT_NE(settings, sweep_settings(keys(), options));
}

/// A program in place of canyon: it does what it is told by a setting, and else leaves sound results.
class SweepTest : public ::testing::Test {
 protected:
  SweepTest() : program_(folder_.file("program.sh")) {
    EXPECT_TRUE(write_text_file(program_, R"(#!/bin/bash
case "$*" in
  *model=\"crash\"*) kill -SEGV $$ ;;
  *model=\"hang\"*) while true; do :; done ;;
  *model=\"refuse\"*) echo "--set:1: model: is \"refuse\", expected another" >&2; exit 2 ;;
  *model=\"mutter\"*) echo "no" >&2; echo "way" >&2; exit 2 ;;
  *model=\"internal\"*) echo "x.cpp:3: check failed: a > b, expected better" >&2; exit 2 ;;
  *model=\"one\"*) echo "vehicle: not finite" >&2; exit 1 ;;
esac
mkdir -p results/epochs
echo '{"map_error_rms_m": null}' > results/summary.json
echo 't_s,x_m
0,1' > results/epochs/high_nav.csv
case "$*" in
  *model=\"nan\"*) echo '1,nan' >> results/epochs/high_nav.csv ;;
  *model=\"hole\"*) echo '1,,3' >> results/epochs/high_nav.csv ;;
  *model=\"litter\"*) mkdir .results.partial ;;
esac
)")
                    .ok());
    chmod(program_.c_str(), 0755);
  }
  Sweep sweep(const std::vector<std::string>& values) {
    SweptKey key{.key = "model", .numeric = false, .values = {}};
    for (const std::string& value : values) key.values.push_back("\"" + value + "\"");
    SweepOptions options{.setup = {.program = program_, .mission = "", .fidelity = "high"},
                         .seed = 1,
                         .pairs = 0,
                         .budget_s = {},
                         .show_progress = false};
    options.setup.limits.cpu_s = 1.0;
    return sweep_mission({key}, options);
  }
  std::string what(const std::string& value) {
    const Sweep found = sweep({value});
    return found.failures.empty() ? "" : found.failures.front().what;
  }
  canyon::testing::TemporaryFolder folder_;
  std::string program_;
};

TEST_F(SweepTest, FiniteResultsAndRefusalsAreFine) {
  const Sweep found = sweep({"fine", "refuse"});
  EXPECT_TRUE(found.failures.empty());
  EXPECT_EQ(found.refused, 1);
  EXPECT_EQ(found.keys_tried, 1);
  EXPECT_EQ(found.values_tried, 2);
}

TEST_F(SweepTest, WhatMustNeverBeIsFound) {
  EXPECT_THAT(what("crash"), HasSubstr("signal 11"));
  EXPECT_THAT(what("hang"), HasSubstr("of CPU time"));
  EXPECT_EQ(what("mutter"), "an error of 2 lines: \"no\nway\n\"");
  EXPECT_THAT(what("internal"), HasSubstr("an internal error: "));
  EXPECT_EQ(what("one"), "exit status 1: \"vehicle: not finite\n\"");
  EXPECT_EQ(what("nan"), "a number that is not finite in high_nav.csv");
  EXPECT_EQ(what("hole"), "an estimate that is not finite in high_nav.csv");
  EXPECT_EQ(what("litter"), "left behind: .results.partial");
}

TEST_F(SweepTest, FailuresStandInTheOrderOfTheSettings) {
  const Sweep found = sweep({"hole", "fine", "crash", "nan"});
  ASSERT_EQ(found.failures.size(), 3U);
  EXPECT_EQ(found.failures[0].settings.front().second, "\"hole\"");
  EXPECT_EQ(found.failures[2].settings.front().second, "\"nan\"");
  EXPECT_THAT(sweep_table(found), HasSubstr("1 keys with 4 values and 0 pairs: 0 refused, 3 failed\n"));
}

}  // namespace
}  // namespace canyon::study
