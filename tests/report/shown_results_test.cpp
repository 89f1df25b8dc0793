// What the page shows of results, and of what they lack.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/tests/report/results_page.h"

namespace canyon::report {
namespace {

using canyon::testing::edit_json;
using canyon::testing::load;
using canyon::testing::section;
using canyon::testing::store;
using ::testing::HasSubstr;
using ::testing::Not;

class ShownResults : public canyon::testing::ResultsPage {};

// 2026-11-21: the page said that all fixes were accepted, and nowhere that some were far outside what the filter
// expected.
TEST_F(ShownResults, FixesThatSurpriseTheFilterAreCountedAndDrawn) {
  std::string csv = load(file("epochs/high_gnss.csv"));
  // Of the columns nis is the last but one.
  const auto with_nis = [](const std::string& table, const std::string& nis) {
    return std::regex_replace(table, std::regex("(,differential,.*,)[^,\n]*(,[^,\n]*)"), "$01" + nis + "$2");
  };
  csv = with_nis(csv, "2.5");
  const std::size_t row = csv.find(",differential,"), end = csv.find('\n', row);
  csv = csv.substr(0, row) + with_nis(csv.substr(row, end - row), "72") + csv.substr(end);
  store(file("epochs/high_gnss.csv"), csv);
  const std::string errors = section(page(), "errors");
  EXPECT_TRUE(std::regex_search(errors, std::regex("; 1 of [0-9]+\xC2\xA0"
                                                   "fixes has a NIS above 16\\.3")));
  EXPECT_THAT(errors, HasSubstr("Error of the fix, 3-D (logarithmic)"));
  EXPECT_THAT(errors, HasSubstr("Dashed: 16.3, which an honest filter"));
  EXPECT_THAT(errors, HasSubstr("<path class=\"limit\""));
  // Without GNSS epochs the two panels are left out.
  std::filesystem::remove(file("epochs/high_gnss.csv"));
  std::filesystem::remove(file("epochs/low_gnss.csv"));
  EXPECT_THAT(section(page(), "errors"), Not(HasSubstr("Error of the fix")));
}

TEST_F(ShownResults, ASingleRunHasNoRatio) {
  edit_json(file("summary.json"), [](auto& json) { json["runs"].erase(0); });
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("<h1>Run high fails after "));
  EXPECT_THAT(html, Not(HasSubstr("class=\"ratio")));
  EXPECT_THAT(html, Not(HasSubstr("GNSS or IMU?"))) << "nothing stands beside it";
}

TEST_F(ShownResults, TwoEqualOutcomesAreComparedByTheirErrors) {
  edit_json(file("summary.json"), [](auto& json) {
    for (auto& run : json["runs"]) run["outcome"] = "success", run["failure"] = nullptr;
    json["runs"][0]["position_error_rms_m"] = 0.25;
    json["runs"][1]["position_error_rms_m"] = 3.0;
  });
  EXPECT_THAT(
      page(),
      HasSubstr("<h1>Run low and run high both complete the mission; the position error is 12.0 times as large in "
                "run high.</h1>"));
}

TEST_F(ShownResults, ARunThatItsTimeLimitStoppedHasNotFailed) {
  edit_json(file("summary.json"), [](auto& json) {
    for (auto& run : json["runs"]) run["outcome"] = "stopped", run["failure"] = nullptr;
  });
  EXPECT_THAT(page(),
              HasSubstr("<h1>Run low and run high are both stopped by their time limit; the position error is "));
  EXPECT_THAT(page(), HasSubstr("<td class=\"outcome neither\">\xE2\x97\x8B stopped</td>"));
  EXPECT_THAT(page(), Not(HasSubstr("mark-of bad")));
  edit_json(file("summary.json"), [](auto& json) { json["runs"][0]["outcome"] = "collision"; });
  EXPECT_THAT(page(), ::testing::ContainsRegex("<h1>Run low fails after [^;]+; run high is stopped after "));
}

// why.json beside the results: the verdict's section says it, and what it lacks or has too much of is one line.
TEST_F(ShownResults, WhyARunFailedStandsWithItsVerdict) {
  store(file("why.json"), R"({"failures": [{"run": "high", "verdict": "cause: errors of the <inertial> sensor",
    "chain": ["3.0 s: no fix", "8.1 s: collision"], "draws": 10, "success_as_it_was": 1,
    "removals": [{"removal": "imu", "success": 9, "p": 0.004, "low": 0.4, "high": 0.95, "rescues": true},
                 {"removal": "height", "success": 1, "p": 1, "low": -0.2, "high": 0.2, "rescues": false}]}]})");
  const std::string verdict = section(page(), "verdict");
  EXPECT_THAT(verdict, HasSubstr("<strong>Why:</strong> cause: errors of the &lt;inertial&gt; sensor"));
  EXPECT_THAT(verdict, HasSubstr("<li>3.0 s: no fix</li>"));
  EXPECT_THAT(verdict, HasSubstr("9 of 10"));
  EXPECT_THAT(verdict, HasSubstr("40 to 95"));
  store(file("why.json"), R"({"failures": [{"run": "nobody", "verdict": "", "chain": [], "draws": 10,
    "success_as_it_was": 1, "removals": []}]})");
  EXPECT_EQ(error(), "why.json:1: failures[0].run: no run \"nobody\", expected a run of summary.json");
  store(file("why.json"), R"({"failures": [{"run": "high", "verdict": "", "chain": [7], "draws": 10,
    "success_as_it_was": 1, "removals": []}]})");
  EXPECT_EQ(error(), "why.json:1: failures[0].chain: number 7, expected a string");
}

TEST_F(ShownResults, RunsStandInTheOrderAskedFor) {
  edit_json(file("summary.json"), [](auto& json) { std::swap(json["runs"][0], json["runs"][1]); });
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("<h1>Run high fails after "));
  const std::string verdict = section(html, "verdict");
  EXPECT_LT(verdict.find("<strong>high</strong>"), verdict.find("<strong>low</strong>"));
  EXPECT_THAT(section(html, "figures"), HasSubstr("<th scope=\"col\">low\xE2\x80\x89/\xE2\x80\x89high</th>"));
}

TEST_F(ShownResults, WithoutRegistrationOneNoteStandsForThePanel) {
  for (const char* run : {"low", "high"}) {
    const std::string path = file(std::string("epochs/") + run + "_keyframes.csv");
    std::string csv = load(path);
    csv = std::regex_replace(csv, std::regex(",(converged|not_converged|too_few_points),"), ",not_registered,");
    store(path, csv);
    std::filesystem::remove(file(std::string("clouds/") + run + "_registered.pcd"));
  }
  edit_json(file("summary.json"), [](auto& json) {
    for (auto& run : json["runs"])
      for (const char* key : {"registration_error_rms_m", "keyframes_converged", "map_error_rms_m"}) run[key] = nullptr;
  });
  const std::string registration = section(page(), "registration");
  EXPECT_THAT(registration,
              HasSubstr("Runs low and high registered nothing ([registration] method = &quot;none&quot;): "
                        "each keyframe stands where the filter placed it."));
  EXPECT_THAT(registration, Not(HasSubstr("converge")));
  EXPECT_THAT(registration, Not(HasSubstr("made the pose better")));
  EXPECT_THAT(section(page(), "maps"), Not(HasSubstr("hold no registered")));
}

TEST_F(ShownResults, TheRegistrationTellsHowKeyframesEnded) {
  const std::string path = file("epochs/high_keyframes.csv");
  std::string csv = load(path);
  const std::string converged = ",converged,9,0.08,5,0", not_converged = ",not_converged,9,0.08,5,";
  const auto count_of = [&csv](const std::string& words) {
    std::size_t count = 0;
    for (std::size_t at = csv.find(words); at != std::string::npos; at = csv.find(words, at + 1)) ++count;
    return count;
  };
  const std::size_t count = count_of(converged), steps = count + count_of(not_converged);
  ASSERT_GT(count, 3U);
  ASSERT_GT(steps, count + 1);
  const auto say = [&csv](const std::string& in_place_of, const std::string& words) {
    csv.replace(csv.find(in_place_of), in_place_of.size(), words);
  };
  say(converged, ",converged,9,0.08,40,0");
  say(converged, ",converged,9,0.08,5,2");
  say(converged, ",ambiguous,9,0.08,5,");
  say(not_converged, ",not_converged,9,0.08,40,");
  say(not_converged, ",not_converged,9,0.08,,");  // without a covariance nothing bounds it
  store(path, csv);
  const std::string registration = section(page(), "registration");
  EXPECT_THAT(registration, HasSubstr("They ended: converged " + std::to_string(count - 1)));
  EXPECT_THAT(registration, HasSubstr(", ambiguous 1"));
  // As study/keyframes.py counts: every step, whatever its alignment's status.
  EXPECT_THAT(registration,
              HasSubstr(" Of " + std::to_string(steps) +
                        "\xC2\xA0"
                        "steps, beyond their own 99.9 % bound: 3 (2 of them did not converge). Converged with a "
                        "direction left open: 1."));
  // PCL's methods tell of no directions; and words of a file are no page's text.
  csv = std::regex_replace(csv, std::regex(",[0-9]\n"), ",\n");
  csv = std::regex_replace(csv, std::regex("ambiguous"), "<b>");
  store(path, csv);
  const std::string plain = section(page(), "registration");
  EXPECT_THAT(plain, Not(HasSubstr("left open: 1")));
  EXPECT_THAT(plain, HasSubstr("&lt;b&gt; 1"));
}

// Files of before 2026-11-29 have no columns of the alignment alone, and the page needs none of them.
TEST_F(ShownResults, KeyframesAreReadWithAndWithoutTheirAlignments) {
  const std::string without = section(page(), "registration");
  for (const char* run : {"low", "high"}) {
    const std::string path = file(std::string("epochs/") + run + "_keyframes.csv"), csv = load(path);
    const std::size_t header = csv.find('\n');
    store(path, csv.substr(0, header) + ",align_nees,align_covariance,covariance,open_vectors" +
                    std::regex_replace(csv.substr(header), std::regex("([^\n])\n"),
                                       "$1,5.1,1e-06 -2e-07,0.01 0,0 0 0 1 0 0;0.04 0 0 0 0 0\n"));
  }
  EXPECT_EQ(section(page(), "registration"), without);
}

TEST_F(ShownResults, AnErrorAtTheCapIsNotANumber) {
  edit_json(file("summary.json"), [](auto& json) {
    json["runs"][0]["map_error_p95_m"] = 5.0;
    json["runs"][1]["map_error_p95_m"] = 5.0;
  });
  EXPECT_THAT(section(page(), "figures"), HasSubstr("map error, registered, 95 %</th><td>\xE2\x89\xA5\xC2\xA0"
                                                    "5</td><td>\xE2\x89\xA5\xC2\xA0"
                                                    "5</td><td class=\"undefined\">"));
}

TEST_F(ShownResults, AFailureIsToldByItsOwnCircumstances) {
  edit_json(file("summary.json"), [](auto& json) {
    json["runs"][1]["failure"]["t_s"] = 12.0;
    json["mission"]["waypoints"][1]["name"] = "crossing";
  });
  std::string csv = load(file("epochs/high_gnss.csv"));
  csv = std::regex_replace(csv, std::regex("\n12,.*"),
                           "\n12,1590,392412,none,,9,1,0,0,,,,,,,,,,,0,0,0,,,,,0,,1 satellite; 4 needed");
  store(file("epochs/high_gnss.csv"), csv);
  const std::string verdict = section(page(), "verdict");
  EXPECT_THAT(verdict, HasSubstr("on its way to waypoint \xE2\x80\x9C"
                                 "crossing\xE2\x80\x9D"));
  EXPECT_THAT(verdict, HasSubstr("In the 12\xC2\xA0s before: "));
  EXPECT_THAT(verdict, HasSubstr("without a fix (the last: 1 satellite; 4 needed)"));
  EXPECT_THAT(section(page(), "scene-section"), HasSubstr(" from truth horizontally ("));
  EXPECT_THAT(section(page(), "scene-section"), HasSubstr(" in 3-D)"));
}

TEST_F(ShownResults, APanelOfOneRunShowsNoOthersFailure) {
  edit_json(file("summary.json"), [](auto& json) {
    json["runs"][0]["outcome"] = "stuck";
    json["runs"][0]["failure"] = {{"kind", "stuck"}, {"t_s", 5.0}, {"x_m", 1.0}, {"y_m", 1.0}, {"detail", "x"}};
  });
  const std::string registration = section(page(), "registration");
  std::size_t marks = 0;
  for (std::size_t at = 0; (at = registration.find("<path class=\"mark ", at)) != std::string::npos; ++at) ++marks;
  EXPECT_EQ(marks, 2u);  // one panel each, one mark each
  std::size_t labels = 0;
  for (std::size_t at = 0; (at = registration.find("class=\"mark-label ", at)) != std::string::npos; ++at) ++labels;
  EXPECT_EQ(labels, 2u);
}

TEST_F(ShownResults, ALoneRunWithoutSatellitesHasNoEmptyChart) {
  edit_json(file("summary.json"), [](auto& json) { json["runs"].erase(1); });
  const std::string satellites = section(page(), "satellites");
  EXPECT_THAT(satellites, HasSubstr("Run low has no satellites"));
  EXPECT_THAT(satellites, Not(HasSubstr("class=\"chart")));
}

TEST_F(ShownResults, WithoutEpochsAndCloudsItSaysSo) {
  std::filesystem::remove_all(file("epochs"));
  std::filesystem::remove_all(file("clouds"));
  std::filesystem::remove(file("manifest.json"));
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("The path of run high is missing: the results hold no epochs/high_nav.csv."));
  EXPECT_THAT(html,
              HasSubstr("Run low is not drawn: the results hold no navigation epochs of it (epochs/low_nav.csv)."));
  EXPECT_THAT(html, HasSubstr("Run low is not drawn: the results hold no GNSS epochs of it (epochs/low_gnss.csv)."));
  EXPECT_THAT(html, HasSubstr("Run high has no satellites to show: its GNSS model has none, or the results hold no "
                              "epochs/high_satellites.csv."));
  EXPECT_THAT(html, HasSubstr("Run low: the results hold no prior and registered map cloud with points."));
  EXPECT_THAT(html,
              HasSubstr("Run high is not drawn: the results hold no keyframes of it (epochs/high_keyframes.csv)."));
  EXPECT_THAT(html, HasSubstr("one drive of each cannot tell"));
  EXPECT_THAT(html, HasSubstr("<dt>Canyon version</dt><dd><span class=\"undefined\">not recorded</span>"));
}

TEST_F(ShownResults, WhatItsLidarKnewOfTheThingThatWasHit) {
  const auto with = [&](double in_scans_s, double range_m, double ago_s) {
    edit_json(file("summary.json"), [&](auto& summary) {
      auto& run = summary["runs"][1];
      run["failure"]["kind"] = "collision", run["failure"]["detail"] = "hit vehicle 350";
      const auto number = [](double v) {
        return std::isfinite(v) ? nlohmann::ordered_json(v) : nlohmann::ordered_json();
      };
      run["hit_in_scans_s"] = number(in_scans_s), run["hit_last_range_m"] = number(range_m);
      run["hit_last_seen_s"] = number(ago_s);
    });
    return section(page(), "verdict");
  };
  const double none = std::nan("");
  EXPECT_THAT(with(1.4, 4.2, 0.05),
              HasSubstr("hit a parked car (vehicle 350), seen by its LIDAR for the last 1.4\xC2\xA0s, "
                        "in the end 4.2\xC2\xA0m off, after "));
  EXPECT_THAT(with(0.3, 2.0, 1.5),
              HasSubstr("(vehicle 350), last seen by its LIDAR 2.0\xC2\xA0m off, 1.5\xC2\xA0s before, after "));
  EXPECT_THAT(with(0.0, none, none), HasSubstr("(vehicle 350), which no scan of its LIDAR had shown, after "));
  EXPECT_THAT(with(none, none, none), HasSubstr("(vehicle 350) after "));
  EXPECT_THAT(with(none, none, none), Not(HasSubstr("Hit vehicle 350"))) << "said once, in words";
}

TEST_F(ShownResults, TheTwoByTwoOverSeedsSaysHowManySucceed) {
  edit_json(file("summary.json"), [](auto& summary) {
    summary["two_by_two"] = {{"gnss", {"low", "high"}},
                             {"imu", {"low", "high"}},
                             {"successes", {{3, 2}, {1, 0}}},
                             {"position_error_rms_m", {{0.1, 0.2}, {3.0, 4.0}}}};
    summary["seeds"] = {1, 2, 3};
  });
  const std::string html = section(page(), "two-by-two");
  EXPECT_THAT(html, HasSubstr("2 of 3 seeds succeed"));
  edit_json(file("summary.json"), [](auto& summary) { summary["two_by_two"]["ended"] = {{3, 2}, {3, 0}}; });
  EXPECT_THAT(section(page(), "two-by-two"), HasSubstr("2 of 2 seeds succeed"));
  EXPECT_THAT(section(page(), "two-by-two"), HasSubstr("all seeds stopped"));
  EXPECT_THAT(html, HasSubstr("Medians over 3 seeds"));
}

// 2026-11-22: the page said "within 3 m" whatever the mission asked for.
TEST_F(ShownResults, TheRadiusIsThatOfTheMission) {
  EXPECT_THAT(section(page(), "figures"),
              HasSubstr("on truth within [success] waypoint_radius_m, with a stop of [success] stop_s<"));
  const auto configure = [&](const char* run, double radius_m, double stop_s) {
    edit_json(file("manifest.json"), [&](auto& json) {
      json["configuration"][run]["success"] = {{"waypoint_radius_m", radius_m}, {"stop_s", stop_s}};
    });
  };
  configure("low", 40.0, 7.0);
  configure("high", 40.0, 7.0);
  EXPECT_THAT(section(page(), "figures"), HasSubstr("on truth within 40\xC2\xA0m, with a stop of 7\xC2\xA0s<"));
  configure("high", 2.0, 7.0);
  EXPECT_THAT(section(page(), "figures"), HasSubstr("within 2\xC2\xA0m to 40\xC2\xA0m, with a stop of 7\xC2\xA0s<"));
  EXPECT_THAT(section(page(), "figures"), Not(HasSubstr("within 3\xC2\xA0m")));
}

TEST_F(ShownResults, AnIntervalStandsBeneathItsValue) {
  edit_json(file("summary.json"), [](auto& json) {
    json["runs"][0]["position_error_rms_m"] = 0.25;
    json["runs"][0]["intervals"] = {{"position_error_rms_m", {{"low", 0.2}, {"high", 0.31}}}};
  });
  EXPECT_THAT(section(page(), "figures"), HasSubstr("<td>0.250<span class=\"def\">0.200 to 0.310</span></td>"));
  edit_json(file("summary.json"), [](auto& json) { json["runs"][0]["intervals"]["position_error_rms_m"] = 3; });
  EXPECT_THAT(error(), ::testing::MatchesRegex("summary.json:[0-9]+: runs\\[0\\].intervals.position_error_rms_m: .*"));
}

// A figure that this program has never heard of has its line as soon as the results describe it.
TEST_F(ShownResults, AFigureIsShownAsTheResultsDescribeIt) {
  edit_json(file("summary.json"), [](auto& json) {
    json["figures"].push_back({{"key", "bumps"},
                               {"group", "Road"},
                               {"label", "bumps met"},
                               {"unit", "1/km"},
                               {"kind", "quantity"},
                               {"better", "lower"},
                               {"meaning", "higher than 5 cm"}});
    for (auto& run : json["runs"]) run["bumps"] = 42.0;
  });
  EXPECT_THAT(section(page(), "figures"),
              HasSubstr("Road</th></tr>\n<tr><th scope=\"row\">bumps met<span class=\"def\">higher than 5 "
                        "cm</span></th><td>42.0</td><td>42.0</td><td class=\"ratio\">1.00</td><td "
                        "class=\"unit\">1/km</td><td class=\"unit\">lower</td></tr>"));
}

TEST_F(ShownResults, ResultsOfBeforeFiguresWereDescribedShowTheirKeys) {
  edit_json(file("summary.json"), [](auto& json) { json.erase("figures"); });
  const std::string figures = section(page(), "figures");
  EXPECT_THAT(figures, HasSubstr("<th scope=\"row\">position_error_rms_m</th>"));
  EXPECT_THAT(section(page(), "verdict"), HasSubstr("<strong>high</strong> failed: it hit an obstacle after "));
}

}  // namespace
}  // namespace canyon::report
