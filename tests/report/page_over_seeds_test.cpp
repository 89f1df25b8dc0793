// The page of several seeds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/study/results/over_seeds.h"
#include "canyon/tests/report/results_page.h"

namespace canyon::report {
namespace {

using canyon::testing::edit_json;
using canyon::testing::section;
using canyon::testing::store;
using ::testing::HasSubstr;
using ::testing::Not;

class PageOverSeeds : public canyon::testing::ResultsPage {};

/// Ten seeds: run low succeeds with all, run high with the third of them only.
std::vector<std::vector<study::RunSummary>> ten_seeds(bool open_loop) {
  std::vector<std::vector<study::RunSummary>> seeds;
  for (int k = 0; k < 10; ++k) {
    auto& runs = seeds.emplace_back();
    for (const char* name : {"low", "high"}) {
      study::RunSummary run;
      run.name = run.gnss = run.imu = name;
      run.seed = 42 + k;
      run.open_loop = open_loop;
      run.outcome = run.name == "low" || k == 2 ? mission::Outcome::kSuccess : mission::Outcome::kCollision;
      run.position_m.rms = run.name == "low" ? 0.1 : 4.0 + k;
      runs.push_back(run);
    }
  }
  return seeds;
}

TEST_F(PageOverSeeds, SharesDifferencesAndMediansAreShown) {
  edit_json(file("summary.json"), [](auto& json) {
    study::write_over_seeds(study::over_seeds(ten_seeds(false)), json);
    // A run of a further seed is not drawn.
    auto further = json["runs"][0];
    further["seed"] = 43;
    json["runs"].push_back(further);
  });
  const std::string html = page(), seeds = section(html, "seeds");
  EXPECT_THAT(html, HasSubstr("<a href=\"#seeds\">Over seeds</a>"));
  EXPECT_THAT(seeds, HasSubstr("Over 10 seeds"));
  EXPECT_THAT(seeds, HasSubstr("seeds 42 to 51"));
  EXPECT_THAT(seeds, HasSubstr("<td>1 of 10</td>"));
  EXPECT_THAT(seeds, HasSubstr("collision 9 and success 1"));
  EXPECT_THAT(seeds, HasSubstr("share of success</td><td>\xE2\x88\x92"
                               "90.0\xC2\xA0%</td>"));
  // Nine discordant pairs of ten, all one way: p = 2 / 2^9.
  EXPECT_THAT(seeds, HasSubstr("<td>0.0039</td><td>10</td>"));
  EXPECT_THAT(seeds, HasSubstr("<td>8.50<span class=\"def\">5.00 to 12.0</span></td>"));
  EXPECT_EQ(html.find("show run low", html.find("show run low") + 1), std::string::npos);
}

// The first seed's explanation stands with its run's verdict, those of the others stand here, and all are counted.
TEST_F(PageOverSeeds, WhatFailuresComeFromIsCountedAndToldSeedBySeed) {
  edit_json(file("summary.json"),
            [](auto& json) { study::write_over_seeds(study::over_seeds(ten_seeds(false)), json); });
  EXPECT_THAT(section(page(), "seeds"), Not(HasSubstr("What failures come from")));
  store(file("why.json"), R"({"failures": [
    {"run": "high", "seed": 42, "verdict": "of the first <seed>", "chain": [], "draws": 12, "success_as_it_was": 0,
     "removals": []},
    {"run": "high", "seed": 43, "verdict": "because of <something>", "chain": ["3.0 s: no <fix>"], "draws": 12,
     "success_as_it_was": 1, "removals": [
       {"removal": "imu", "success": 11, "p": 0.001, "low": 0.4, "high": 0.95, "rescues": true}]}],
    "tally": [{"run": "high", "failed": 9, "explained": 2, "verdicts": [
      {"verdict": "imu", "words": "because of <something>", "n": 1, "low": 0.0945, "high": 0.9055},
      {"verdict": "not_navigation", "words": "navigation is not to blame", "n": 1, "low": 0.0945, "high": 0.9055,
       "note": "in 0 of <12>"}]}]})");
  const std::string html = page(), verdict = section(html, "verdict"), seeds = section(html, "seeds");
  EXPECT_THAT(verdict, HasSubstr("<strong>Why:</strong> of the first &lt;seed&gt;."));
  EXPECT_THAT(verdict, Not(HasSubstr("because of")));
  EXPECT_THAT(seeds, HasSubstr("Explained by replays: 2 of 9\xC2\xA0"
                               "failures of run high, the first ones by seed."));
  EXPECT_THAT(seeds, HasSubstr("<td class=\"text\">because of &lt;something&gt;</td><td>1 of 2</td>"));
  EXPECT_THAT(seeds,
              HasSubstr("navigation is not to blame<span class=\"def\">in 0 of &lt;12&gt;</span></td><td>1 of 2"));
  EXPECT_THAT(seeds, HasSubstr("<summary>high, seed 43: because of &lt;something&gt;.</summary>"));
  EXPECT_THAT(seeds, HasSubstr("<li>3.0 s: no &lt;fix&gt;</li>"));
  EXPECT_THAT(seeds, HasSubstr("<td>11 of 12</td>"));
  EXPECT_THAT(seeds, Not(HasSubstr("of the first")));

  store(file("why.json"),
        R"({"failures": [], "tally": [{"run": "nobody", "failed": 1, "explained": 1, "verdicts": []}]})");
  EXPECT_EQ(error(), "why.json:1: tally[0].run: no run \"nobody\", expected a run of summary.json");
  store(file("why.json"), R"({"failures": [], "tally": [{"run": "high", "failed": 1, "explained": 1, "verdicts": [
    {"verdict": "imu", "words": "", "n": 1, "low": 0.2, "high": 1.5}]}]})");
  EXPECT_EQ(error(), "why.json:2: tally[0].verdicts[0].high: number 1.50000, expected a share between 0 and 1");
}

TEST_F(PageOverSeeds, AnOpenLoopHasNoShares) {
  edit_json(file("summary.json"), [](auto& json) {
    study::write_over_seeds(study::over_seeds(ten_seeds(true)), json);
    json["loop"] = {{"kind", "open"}, {"tape", "a drive"}, {"paired_epochs", nlohmann::json::array()}};
    for (auto& run : json["runs"]) run["outcome"] = nullptr;
  });
  const std::string seeds = section(page(), "seeds");
  EXPECT_THAT(seeds, Not(HasSubstr("Share of success")));
  EXPECT_THAT(seeds, HasSubstr("<td class=\"text\">position error, RMS</td><td>8.40\xC2\xA0m</td>"));
}

/// summary.json's open_loop: the same runs on one true motion.
nlohmann::json beside(const nlohmann::json& closed) {
  nlohmann::json out{{"tape", "a <drive>"},
                     {"duration_s", 60.0},
                     {"runs", closed},
                     {"paired_epochs",
                      {{{"a", "low"},
                        {"b", "high"},
                        {"epochs", 590},
                        {"position_error_difference_m", 2.5},
                        {"low_m", 1.5},
                        {"high_m", 3.25},
                        {"worse_share", 0.9}}}}};
  for (auto& run : out["runs"]) {
    run["outcome"] = nullptr;
    run["failure"] = nullptr;
    run["waypoints_reached"] = run["mission_waypoints_reached"] = nullptr;
    run["position_error_rms_m"] = run["fidelity"] == "low" ? 0.25 : 2.75;
  }
  return out;
}

TEST_F(PageOverSeeds, ClosedAndOpenLoopStandSideBySide) {
  EXPECT_EQ(section(page(), "loops"), "");
  edit_json(file("summary.json"), [](auto& json) { json["open_loop"] = beside(json["runs"]); });
  const std::string html = page(), loops = section(html, "loops");
  EXPECT_THAT(html, HasSubstr("<a href=\"#loops\">Both loops</a>"));
  EXPECT_THAT(loops, HasSubstr("on one true motion (a &lt;drive&gt;, 60.0\xC2\xA0s)"));
  EXPECT_THAT(loops, HasSubstr("Epoch by epoch high errs by 2.50\xC2\xA0m more than low on it (95 % interval 1.50 to "
                               "3.25\xC2\xA0m)."));
  EXPECT_THAT(loops, ::testing::ContainsRegex("position error, RMS</th><td>[0-9.]+</td><td>0.250</td><td>[0-9.]+</td>"
                                              "<td>2.75</td>"));
  EXPECT_THAT(loops, Not(HasSubstr("waypoints reached")));  // nobody drove
}

TEST_F(PageOverSeeds, ARunThatErrsLessInTheOpenLoopIsSaidToErrLess) {
  edit_json(file("summary.json"), [](auto& json) {
    json["open_loop"] = beside(json["runs"]);
    auto& pair = json["open_loop"]["paired_epochs"][0];
    pair["position_error_difference_m"] = -2.5, pair["low_m"] = -3.25, pair["high_m"] = -1.5;
  });
  EXPECT_THAT(section(page(), "loops"), HasSubstr("Epoch by epoch high errs by 2.50\xC2\xA0m less than low on it (95 % "
                                                  "interval 1.50 to 3.25\xC2\xA0m)."));
  edit_json(file("summary.json"), [](auto& json) {
    for (const char* key : {"position_error_difference_m", "low_m", "high_m"})
      json["open_loop"]["paired_epochs"][0][key] = nullptr;
  });
  EXPECT_THAT(section(page(), "loops"), Not(HasSubstr("Epoch by epoch")));
}

TEST_F(PageOverSeeds, WhatIsWrongWithTheOtherLoopIsSaid) {
  edit_json(file("summary.json"), [](auto& json) {
    json["open_loop"] = beside(json["runs"]);
    study::write_over_seeds(study::over_seeds(ten_seeds(true)), json["open_loop"]);
  });
  EXPECT_THAT(error(), ::testing::MatchesRegex(
                           "summary.json:[0-9]+: open_loop.seeds: given, expected none, as of the closed loop"));
  edit_json(file("summary.json"), [](auto& json) { json["open_loop"]["runs"] = nlohmann::json::array(); });
  EXPECT_THAT(error(),
              ::testing::MatchesRegex("summary.json:[0-9]+: open_loop.runs: empty, expected at least one run"));
}

TEST_F(PageOverSeeds, BothLoopsOverSeedsAreMedians) {
  edit_json(file("summary.json"), [](auto& json) {
    study::write_over_seeds(study::over_seeds(ten_seeds(false)), json);
    json["open_loop"] = beside(json["runs"]);
    auto open = ten_seeds(true);
    for (auto& runs : open) runs[1].position_m.rms = 3.0;
    study::write_over_seeds(study::over_seeds(open), json["open_loop"]);
  });
  const std::string loops = section(page(), "loops");
  EXPECT_THAT(loops, HasSubstr("Medians over 10 seeds."));
  EXPECT_THAT(loops, HasSubstr("more than low on it, with the first seed (95 % interval"));
  EXPECT_THAT(loops, HasSubstr("10 of 10 succeed"));
  EXPECT_THAT(loops, HasSubstr("1 of 10 succeed"));
  EXPECT_THAT(loops, HasSubstr("position error, RMS</th><td>0.100</td><td>0.100</td><td>8.50</td><td>3.00</td>"));
}

}  // namespace
}  // namespace canyon::report
