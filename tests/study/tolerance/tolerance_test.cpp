#include "canyon/study/tolerance/tolerance.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "canyon/study/statistics/proportions.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::study {
namespace {

TolerancePoint point(double size, int success, int n) {
  return {.size = size, .success = success, .n = n, .interval = wilson_interval(success, n)};
}

TEST(Tolerance, ACurveIsMonotoneWithinItsIntervals) {
  ToleranceCurve curve;
  curve.points = {point(1.0, 18, 20), point(3.0, 12, 20), point(10.0, 14, 20)};
  EXPECT_TRUE(curve.monotone()) << "14 of 20 is no more than 12 of 20, as far as 20 can tell";
  curve.points.push_back(point(30.0, 0, 20));
  EXPECT_TRUE(curve.monotone());
  curve.points.push_back(point(100.0, 20, 20));
  EXPECT_FALSE(curve.monotone());
  std::swap(curve.points.front(), curve.points.back());
  EXPECT_FALSE(curve.monotone()) << "in whatever order they stand";
}

TEST(Tolerance, EveryDisturbanceHasSizesAndItsUnitInItsName) {
  for (const auto& row : disturbances()) {
    EXPECT_GE(usual_sizes(row.name).size(), 5u) << row.name;
    EXPECT_THAT(row.name, ::testing::MatchesRegex(".*_(m|m_s|deg)"));
  }
}

// A street of 60 m, driven by who steers by the pose alone: a constant height changes nothing, 20 m aside all.
TEST(Tolerance, WhoSteersByThePoseAloneTakesHeightAndNoStep) {
  const auto file = mission::MissionFile::parse(
      "base = \"vicksburg\"\n[run]\nname = \"short\"\n[registration]\nmethod = \"none\"\n[vehicle]\n"
      "start_m = [213.9, 30.0]\nstart_heading_deg = 0.0\n[autonomy]\nmodel = \"route_follower\"\n"
      "[[autonomy.waypoint]]\nname = \"goal\"\np_m = [213.9, 90.0]\n",
      "short.toml");
  ASSERT_TRUE(file.ok()) << file.error().str();
  const auto height = tolerance_curve(*file, "low", "height_m", {0.0, 10.0}, 2, false);
  ASSERT_TRUE(height.ok()) << height.error().str();
  EXPECT_EQ(height->points[0].success, 2);
  EXPECT_EQ(height->points[1].success, 2);
  const auto drift = tolerance_curve(*file, "low", "drift_m_s", {0.01, 3.0}, 2, false);
  ASSERT_TRUE(drift.ok()) << drift.error().str();
  EXPECT_EQ(drift->points[0].success, 2);
  EXPECT_EQ(drift->points[1].success, 0);
  EXPECT_TRUE(drift->monotone());
  EXPECT_EQ(tolerance_json(*drift)["points"][1]["n"], 2);
  EXPECT_EQ(tolerance_csv(*drift).substr(0, 24), "size,success,n,low,high\n");
  const auto unknown = tolerance_curve(*file, "low", "hight_m", {1.0}, 1, false);
  ASSERT_FALSE(unknown.ok());
  EXPECT_THAT(unknown.error().str(), ::testing::HasSubstr("nearest is \"height_m\""));
}

/// A street of 65 m with a car in the middle of its lane, driven by who goes around what its LIDAR sees.
constexpr double kLane_m = 213.9;
constexpr const char* kPastACar = R"(
base = "vicksburg"
[run]
name = "past_a_car"
[registration]
method = "none"
[vehicle]
start_m = [213.9, 30.0]
start_heading_deg = 0.0
[autonomy]
model = "reference"
[[autonomy.waypoint]]
name = "goal"
p_m = [213.9, 95.0]
[[scene.moving]]
path_m = [213.9, 62.0, 213.9, 63.0]
start_s = 1e5
)";

mission::testing::RecordedRun told_height_off_by(double size_m) {
  auto file = mission::MissionFile::parse(kPastACar, "past_a_car.toml");
  EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().str());
  model_row(disturbances(), "height_m").make(*file, size_m);
  const auto config = file->resolve("low");
  EXPECT_TRUE(config.ok()) << (config.ok() ? "" : config.error().str());
  return mission::testing::drive(*config);
}

// Not only does it come home: it drives the same way. Ten metres more are rounded otherwise in the poses that a scan is
// put straight by; its returns are kept in single precision, of which the last digit at 100 m is 8 micrometres.
TEST(Tolerance, WhoGoesByWhatItSeesDrivesTheSameWhateverItsHeight) {
  const auto right = told_height_off_by(0.0), wrong = told_height_off_by(10.0);
  EXPECT_EQ(right.outcome, mission::Outcome::kSuccess) << (right.failure ? right.failure->detail : "");
  EXPECT_EQ(wrong.outcome, mission::Outcome::kSuccess) << (wrong.failure ? wrong.failure->detail : "");
  ASSERT_EQ(right.nav.size(), wrong.nav.size());
  double aside_m = 0.0, apart_m = 0.0;
  for (std::size_t i = 0; i < right.nav.size(); ++i) {
    const mission::NavRow &a = right.nav[i], &b = wrong.nav[i];
    EXPECT_NEAR(b.estimate.X_WB.p.z() - a.estimate.X_WB.p.z(), 10.0, 1e-9) << "it is told so";
    aside_m = std::max(aside_m, std::abs(a.X_WB_true.p.x() - kLane_m));
    apart_m = std::max(apart_m, (b.X_WB_true.p - a.X_WB_true.p).norm());
  }
  EXPECT_GT(aside_m, 0.5 * (1.8 + 1.5)) << "half a car and half the vehicle: it has gone around it";
  EXPECT_LT(apart_m, 8e-6);
}

TEST(Tolerance, StoppedMissionsCountForNothing) {
  const auto file = mission::MissionFile::parse(
      "base = \"vicksburg\"\n[run]\nname = \"stopped\"\n[time]\nlimit_s = 1.0\n[registration]\nmethod = \"none\"\n",
      "stopped.toml");
  ASSERT_TRUE(file.ok()) << file.error().str();
  const auto curve = tolerance_curve(*file, "low", "height_m", {2.0}, 2, false);
  ASSERT_TRUE(curve.ok()) << curve.error().str();
  EXPECT_EQ(curve->points[0].n, 0);
  EXPECT_THAT(tolerance_table(*curve), ::testing::HasSubstr("  0 / 0    -               2 stopped\n"));
  EXPECT_EQ(tolerance_csv(*curve), "size,success,n,low,high\n2,0,0,,\n");
  EXPECT_TRUE(tolerance_json(*curve)["points"][0]["low"].is_null());
}

}  // namespace
}  // namespace canyon::study
