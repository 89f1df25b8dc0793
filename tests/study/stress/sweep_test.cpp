#include "canyon/study/stress/sweep/sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include <sys/stat.h>
#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
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
  EXPECT_GE(numeric, 157);
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

// Of a second seed only the pairs are new.
TEST(SweepSettings, OfPairsAloneAreThoseThatFollowTheKeys) {
  SweepOptions options{.setup = {}, .seed = 7, .pairs = 200};
  const auto all = sweep_settings(keys(), options);
  options.singles = false;
  const auto pairs = sweep_settings(keys(), options);
  ASSERT_EQ(pairs.size(), 200U);
  EXPECT_TRUE(std::equal(pairs.begin(), pairs.end(), all.end() - 200));
}

/// A program in place of canyon: it does what it is told by a setting, and else leaves sound results.
class SweepTest : public ::testing::Test {
 protected:
  SweepTest() : program_(folder_.file("program.sh")) {
    EXPECT_TRUE(write_text_file(program_, R"(#!/bin/bash
echo "$*" >> "$0.calls"
case "$*" in
  *model=\"crash\"*) kill -SEGV $$ ;;
  *model=\"hang\"*) while true; do :; done ;;
  *model=\"sleep\"*) exec sleep 100 ;;
  *model=\"kill\"*) kill -KILL $$ ;;
  *model=\"big\"*) exec truncate -s 1100000000 results ;;
  *model=\"nothing\"*) exit 0 ;;
  *model=\"shut\"*) mkdir -p results/in; chmod 0 results/in; exit 0 ;;
  *model=\"vague\"*) echo "sensor: is wrong, expected another" >&2; exit 2 ;;
  *model=\"place\"*) echo "my.toml:7: lidar.rate_hz: is wrong, expected another" >&2; exit 2 ;;
  *model=\"refuse\"*) echo "--set:1: model: is \"refuse\", expected another" >&2; exit 2 ;;
  *model=\"mutter\"*) echo "no" >&2; echo "way" >&2; exit 2 ;;
  *model=\"internal\"*) echo "x.cpp:3: check failed: a > b, expected better" >&2; exit 2 ;;
  *model=\"one\"*) echo "vehicle: not finite" >&2; exit 1 ;;
esac
mkdir -p results/epochs
summary='{"two_by_two": null, "runs": [{"outcome": "stopped", "distance_m": 3.5}]}'
echo 't_s,est_x_m,state
0,1,driving' > results/epochs/high_nav.csv
echo 't_s,status,fix_x_m,reason
0,none,,blocked' > results/epochs/high_gnss.csv
case "$*" in
  *model=\"nan\"*) echo '1,nan,driving' >> results/epochs/high_nav.csv ;;
  *model=\"hole\"*) echo '1,,driving' >> results/epochs/high_nav.csv ;;
  *model=\"end\"*) echo '1,2,' >> results/epochs/high_nav.csv ;;
  *model=\"fix\"*) echo '1,single,,' >> results/epochs/high_gnss.csv ;;
  *model=\"null\"*) summary='{"runs": [{"outcome": "stopped", "distance_m": null}]}' ;;
  *model=\"litter\"*) mkdir .results.partial ;;
  *model=\"temporary\"*) touch "$TMPDIR/left" ;;
esac
echo '{"commit": "1"}' > results/manifest.json
echo "$summary" > results/summary.json
case "$*" in
  *model=\"print\"*) echo '{"runs": [{"distance_m": null}]}' ;;
  *) echo "$summary" ;;
esac
)")
                    .ok());
    chmod(program_.c_str(), 0755);
  }
  Sweep sweep(const std::vector<std::string>& values, std::optional<double> budget_s = {}) {
    SweptKey key{.key = "model", .numeric = false, .values = {}};
    for (const std::string& value : values) key.values.push_back("\"" + value + "\"");
    return *sweep_mission({key}, options(budget_s));
  }
  SweepOptions options(std::optional<double> budget_s = {}) const {
    SweepOptions options{.setup = {.program = program_, .mission = "vicksburg", .fidelity = "high"},
                         .seed = 1,
                         .pairs = 0,
                         .budget_s = budget_s,
                         .show_progress = false};
    options.setup.cpu_per_simulated_s = 0.3;
    return options;
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
  EXPECT_EQ(what("nan"), "high_nav.csv: 3: est_x_m is nan");
  EXPECT_EQ(what("litter"), "left behind: .results.partial");
  EXPECT_EQ(what("temporary"), "left behind in TMPDIR: left");
}

// 2026-11-22: canyon writes what is not finite as an empty field or null, and those were looked for in the middle of a
// line of one file only.
TEST_F(SweepTest, WhatCanyonWritesForNoNumberIsFound) {
  EXPECT_EQ(what("hole"), "high_nav.csv: 3: est_x_m is empty");
  EXPECT_EQ(what("end"), "high_nav.csv: 3: state is empty");
  EXPECT_EQ(what("fix"), "high_gnss.csv: 3: fix_x_m is empty");
  EXPECT_EQ(what("null"), "summary.json: runs[0].distance_m is null");
  EXPECT_EQ(what("print"), "printed: runs[0].distance_m is null");
}

// 2026-11-22: whatever SIGKILL ended was told as too much CPU time, and a file beyond the limit as signal 25.
TEST_F(SweepTest, WhatEndedItIsSaid) {
  EXPECT_THAT(what("kill"), HasSubstr("was killed from outside after "));
  EXPECT_EQ(what("big"), "wrote a file of more than 1 GB");
}

// 2026-11-22: no results at exit status 0, or a folder that cannot be read, threw out of the whole sweep.
TEST_F(SweepTest, NoResultsAreAFailureOfThatTrialAlone) {
  const Sweep found = sweep({"nothing", "fine"});
  ASSERT_EQ(found.failures.size(), 1U);
  EXPECT_THAT(found.failures[0].what, HasSubstr("left no results: "));
  EXPECT_EQ(found.values_tried, 2);
  EXPECT_THAT(what("shut"), HasSubstr("left no "));
}

// 2026-11-22: any one line with "expected" in it was taken for a refusal, wherever it came from, and any exit status 2
// was counted as one.
TEST_F(SweepTest, ARefusalNamesAKeyThatWasSetOrALine) {
  EXPECT_EQ(what("place"), "");
  EXPECT_EQ(what("vague"), "names neither a key that was set nor a line: \"sensor: is wrong, expected another\"");
  EXPECT_EQ(sweep({"vague", "mutter", "refuse"}).refused, 1);
}

// 2026-11-22: time.limit_s = 0 and 1e5 drove the mission to its end, which was told as a hang.
TEST_F(SweepTest, ASweptLimitOfTimeIsNeverLongerThanTheOthers) {
  const SweptKey limit{.key = "time.limit_s", .numeric = true, .values = {"0", "0.5", "1e5"}};
  const Sweep found = *sweep_mission({limit}, options());
  EXPECT_EQ(found.values_tried, 3);
  EXPECT_TRUE(found.failures.empty());
  const auto calls = read_text_file(program_ + ".calls");
  ASSERT_TRUE(calls.ok());
  for (const char* pair :
       {" --threads 1 --set time.limit_s=3\n", "--set time.limit_s=0 --set time.limit_s=3\n",
        "--set time.limit_s=0.5 --set time.limit_s=0.5\n", "--set time.limit_s=1e5 --set time.limit_s=3\n"})
    EXPECT_THAT(*calls, HasSubstr(pair));
}

// 2026-11-22: a mission that never drives was swept with every trial refused, and all was well.
TEST_F(SweepTest, AMissionThatDoesNotDriveAsItStandsIsOneFailure) {
  ASSERT_TRUE(write_text_file(program_, "#!/bin/bash\necho 'my.toml:3: is wrong, expected right' >&2\nexit 2\n").ok());
  const Sweep found = sweep({"fine", "refuse"});
  ASSERT_EQ(found.failures.size(), 1U);
  EXPECT_EQ(found.failures[0].what, "is refused: my.toml:3: is wrong, expected right\n");
  EXPECT_THAT(sweep_table(found), HasSubstr("the mission as it stands: is refused: "));
  EXPECT_EQ(found.values_tried, 0);
  EXPECT_EQ(found.not_tried, 2);
}

// 2026-11-22: a budget of time stopped the starts alone; the last trial could take twenty minutes more.
TEST_F(SweepTest, WhatHasNotEndedWithinTheBudgetIsNotTried) {
  const auto started = std::chrono::steady_clock::now();
  const Sweep found = sweep({"sleep"}, 1.0);
  EXPECT_LT(std::chrono::steady_clock::now() - started, std::chrono::seconds(30)) << "it sleeps for 100 s";
  EXPECT_TRUE(found.failures.empty());
  EXPECT_EQ(found.values_tried, 0);
  EXPECT_EQ(found.not_tried, 1);
  ASSERT_EQ(found.keys_not_tried.size(), 1U);
  EXPECT_THAT(sweep_table(found),
              HasSubstr("1 not tried for lack of time\nno value of: " + found.keys_not_tried[0] + "\n"));
}

// 2026-11-26: a sweep of an hour and a half that was ended said nothing of what it had found.
TEST_F(SweepTest, AnInterruptionTellsWhatHasBeenFound) {
  std::thread user([this] {
    const auto sleeps = [this] {
      const auto calls = read_text_file(program_ + ".calls");
      return calls.ok() && calls->find("model=\"sleep\"") != std::string::npos;
    };
    for (int k = 0; k < 20000 && !sleeps(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    set_cancel_requested(true);
  });
  const int before = threads();
  set_threads(1);
  const Sweep found = sweep({"nan", "fine", "sleep", "crash"});
  set_threads(before);
  user.join();
  set_cancel_requested(false);
  EXPECT_TRUE(found.interrupted);
  ASSERT_EQ(found.failures.size(), 1U);
  EXPECT_EQ(found.failures[0].settings.front().second, "\"nan\"");
  EXPECT_EQ(found.values_tried, 2);
  EXPECT_EQ(found.not_tried, 2);
  EXPECT_THAT(sweep_table(found), HasSubstr(" not tried before the interruption\n"));
  EXPECT_TRUE(sweep_json(found)["interrupted"]);
}

TEST_F(SweepTest, NoPlaceForTemporaryFilesIsOneLine) {
  const char* before = getenv("TMPDIR");
  const std::string kept = before != nullptr ? before : "";
  setenv("TMPDIR", folder_.file("none").c_str(), 1);
  const auto found = sweep_mission({}, options());
  before != nullptr ? setenv("TMPDIR", kept.c_str(), 1) : unsetenv("TMPDIR");
  ASSERT_FALSE(found.ok());
  EXPECT_THAT(found.error().str(), HasSubstr(", expected TMPDIR to be a writable folder"));
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
