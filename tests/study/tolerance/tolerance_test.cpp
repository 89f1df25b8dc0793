#include "canyon/study/tolerance/tolerance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "canyon/study/statistics/proportions.h"

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
