#include "canyon/study/results/figures.h"

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/study/compare.h"
#include "canyon/study/results/results.h"
#include "canyon/study/tables/text_table.h"

namespace canyon::study {
namespace {

using ::testing::HasSubstr;

/// A run in which every figure is defined, and no two of them are equal.
RunSummary full_run() {
  RunSummary run;
  run.name = run.gnss = run.imu = "high";
  run.outcome = mission::Outcome::kSuccess;
  run.waypoints.resize(5);
  run.waypoints[0].mission = run.waypoints[1].mission = true;
  run.waypoints[0].facade_range_m = 40.5;
  run.waypoints[0].facade_obliquity_deg = 20.5;
  run.waypoints[0].facade_px_per_m = 15.5;
  run.waypoints[0].facade_seen_share = 0.625;
  run.believed_not_reached = 3;
  run.encounters = {.clearance_min_m = 0.125, .near_misses = 7, .phantoms = 9, .missed_obstacles = 11};
  run.needless_lane_departures = 13;
  run.failure = mission::Failure{.kind = mission::Outcome::kCollision,
                                 .detail = "a car",
                                 .seen = mission::Sighting{.range_m = 4.5, .stood_s = 1.75, .ago_s = 0.05}};
  run.waypoints_reached = 4;
  run.mission_waypoints_reached = 1;
  double next = 10.0;
  const auto fill = [&next](auto&... members) { ((members = next += 0.25), ...); };
  fill(run.duration_s, run.distance_m, run.roll_rms_deg, run.pitch_rms_deg, run.yaw_rms_deg, run.gdop_median,
       run.gdop_max, run.pdop_median, run.satellites_mean, run.fix_error_rms_m, run.registration_rms_m,
       run.registration_prior_rms_m, run.wall_s, run.cpu_s);
  for (ErrorStatistics* error : {&run.position_m, &run.east_m, &run.north_m, &run.up_m})
    fill(error->rms, error->p95, error->max);
  run.position_rms_interval_m = {1.5, 2.5};
  run.nlos_share = 0.125;
  run.multipath_share = 0.25;
  run.dop_jumps = 17;
  run.fixes_due = 590;
  run.fixes_lost = 27;
  run.keyframes = 60;
  run.keyframes_registered = 59;
  run.keyframes_converged = 51;
  run.prior_map = {.points = 1000,
                   .map_error_rms_m = 0.5,
                   .map_error_p95_m = 5.0,
                   .map_error_up_rms_m = 0.75,
                   .map_error_up_mean_m = 0.0,
                   .up_points = 1,
                   .capped_points = 100};
  run.registered_map = {.points = 800,
                        .map_error_rms_m = 0.375,
                        .map_error_p95_m = 1.5,
                        .map_error_up_rms_m = 0.625,
                        .map_error_up_mean_m = 0.0,
                        .up_points = 1,
                        .capped_points = 48};
  return run;
}

TEST(Figures, EveryRowIsCompleteAndItsKeyIsItsOwn) {
  std::set<std::string> keys;
  for (const Figure& figure : figures()) {
    EXPECT_TRUE(keys.insert(figure.key).second) << figure.key;
    EXPECT_NE(std::string(figure.label), "") << figure.key;
    EXPECT_NE(std::string(figure.group), "") << figure.key;
    EXPECT_TRUE(std::isfinite(figure.get(full_run()))) << figure.key;
    if (figure.total != nullptr) {
      ASSERT_NE(find_figure(figure.total), nullptr) << figure.key;
      EXPECT_LE(figure.get(full_run()), find_figure(figure.total)->get(full_run())) << figure.key;
    }
    // A key says its unit.
    const std::string key = figure.key, unit = figure.unit;
    const bool has_unit = unit == "m" || unit == "s" || unit == "deg";
    EXPECT_TRUE(!has_unit || key.ends_with("_" + unit)) << key;
    EXPECT_EQ(key.ends_with("_share"), figure.kind == Figure::Kind::kShare) << key;
  }
}

// One row is all there is to a figure: whatever is in the table is in summary.json, in its descriptions, in the
// terminal's table, in --figures and in the page of documentation, as often as there are rows.
TEST(Figures, OneRowIsAllThatAFigureTakes) {
  const RunSummary run = full_run();
  const nlohmann::ordered_json json = run_json(run), descriptions = figure_descriptions();
  ASSERT_EQ(descriptions.size(), figures().size());
  const std::string page = figure_reference();
  std::size_t in_json = 0;
  for (const Figure& figure : figures()) {
    const auto& owner = figure.timing ? json["timing"] : json;
    ASSERT_TRUE(owner.contains(figure.key)) << figure.key;
    EXPECT_EQ(owner[figure.key].get<double>(), figure.get(run)) << figure.key;
    EXPECT_EQ(owner[figure.key].is_number_integer(), figure.kind == Figure::Kind::kCount) << figure.key;
    EXPECT_EQ(json["intervals"].contains(figure.key), figure.interval != nullptr) << figure.key;
    EXPECT_THAT(page, HasSubstr("| `" + std::string(figure.key) + "` | "));

    Results results;
    results.summaries = {run};
    const std::string table = comparison_table(results, {figure.key});
    EXPECT_THAT(table, HasSubstr(std::string("  ") + figure.label)) << figure.key;
    EXPECT_THAT(table, HasSubstr(figure_text(figure, estimate(figure, run), kNaN))) << figure.key;
    ++in_json;
  }
  // What else stands in a run of summary.json is no figure.
  const std::set<std::string> others{"fidelity", "gnss",     "imu",       "seed",
                                     "outcome",  "failure",  "intervals", "mission_waypoints",
                                     "verdict",  "counters", "timing",    "waypoints"};
  for (const auto& [key, value] : json.items())
    EXPECT_TRUE(others.count(key) > 0 || find_figure(key) != nullptr) << key;
  EXPECT_EQ(in_json, json.size() - others.size() + json["timing"].size() - 1) << "`parts` is the one other in timing";
}

TEST(Figures, TheDocumentedListIsWhatTheBinaryWrites) {
  const auto page = read_text_file(std::string(CANYON_SOURCE_DIR) + "/docs/results.md");
  ASSERT_TRUE(page.ok()) << page.error().str();
  EXPECT_THAT(*page, HasSubstr("<!-- canyon:figures -->\n" + figure_reference() + "<!-- /canyon:figures -->"))
      << "run: canyon keys --figures, between the markers";
}

TEST(Figures, UndefinedIsNullAndAnOpenLoopHasNoWaypoints) {
  RunSummary run = full_run();
  run.open_loop = true;
  run.outcome = std::nullopt;
  run.gdop_median = kNaN;
  run.keyframes_registered = run.keyframes_converged = std::nullopt;
  run.position_rms_interval_m = {};
  const auto json = run_json(run);
  for (const char* key : {"outcome", "waypoints_reached", "waypoints_planned", "gdop_median", "keyframes_converged",
                          "map_points_capped", "map_points_level", "map_capped_share"})
    EXPECT_TRUE(json[key].is_null()) << key;
  EXPECT_EQ(json["map_points"], 1000);
  EXPECT_TRUE(json["intervals"].empty());
}

TEST(ChooseFigures, AnUnknownOneNamesTheNearest) {
  const auto found = choose_figures({"cpu_s", "map_eror_rms_m"}, "--figures");
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(found.error().str(),
            "--figures: \"map_eror_rms_m\" is no figure, expected one that canyon keys "
            "--figures lists; nearest is \"map_error_rms_m\"");
  EXPECT_EQ(found.error().exit_code, 2);
  EXPECT_THAT(choose_figures({"map_eror"}, "").error().str(), HasSubstr("nearest is \"map_error_prior_rms_m\""));
  ASSERT_TRUE(choose_figures({"cpu_s", "keyframes"}, "--figures").ok());
  EXPECT_STREQ((*choose_figures({"keyframes"}, "--figures"))[0]->key, "keyframes");
}

TEST(FigureText, ValuesIntervalsPartsAndCaps) {
  const auto text = [](const char* key, Estimate found, double total = kNaN) {
    return figure_text(*find_figure(key), found, total);
  };
  EXPECT_EQ(text("position_error_rms_m", {0.1464, {0.1406, 0.152}}), "0.146 [0.141, 0.152]");
  EXPECT_EQ(text("nlos_share", {0.19, {0.1, 0.25}}), "19.0 [10.0, 25.0]");
  EXPECT_EQ(text("fixes_lost", {27, {}}, 590), "27 of 590");
  EXPECT_EQ(text("fixes_lost", {26.5, {}}), "26.5");
  EXPECT_EQ(text("map_error_p95_m", {5.0, {}}), ">= 5");
  EXPECT_EQ(text("gdop_median", {}), "-");
}

}  // namespace
}  // namespace canyon::study
