#include "mission/mission_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace canyon::mission {
namespace {

using ::testing::HasSubstr;

MissionFile parse(const std::string& toml) {
  auto file = MissionFile::parse(toml, "my.toml");
  EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().str());
  return *file;
}

/// The message a user sees for a mission file, whichever step finds the mistake.
std::string message(const std::string& toml) {
  auto file = MissionFile::parse(toml, "my.toml");
  if (!file) return file.error().str();
  const auto config = file->resolve("high");
  if (!config) return file->locate(config.error()).str();
  SceneCache scenes;
  const auto mission = prepare(*config, scenes);
  if (!mission) return file->locate(mission.error()).str();
  const auto sensors = check_sensors(*config, *mission);
  return sensors ? "no mistake" : file->locate(sensors.error()).str();
}

constexpr const char* kEmptyScene = "base = \"vicksburg\"\n[scene]\nempty = true\n";

TEST(MissionFile, BuiltInMissionHasElevenWaypointsOfWhichThreeAreMissionWaypoints) {
  const auto config = MissionFile::load("")->resolve("high");
  ASSERT_TRUE(config.ok()) << config.error().str();
  ASSERT_EQ(config->autonomy.waypoints.size(), 11U);
  for (std::size_t i = 0; i < 11; ++i)
    EXPECT_EQ(config->autonomy.waypoints[i].is_mission(), i == 6 || i == 8 || i == 10) << i + 1;
}

TEST(MissionFile, LayersWinInTheirOrder) {
  // The user's [gnss] holds for every fidelity, the user's [fidelity.low.gnss] for that one, an option over all.
  MissionFile file = parse("base = \"vicksburg\"\n[gnss]\nrate_hz = 5.0\n[fidelity.low.gnss]\nrate_hz = 4.0\n");
  EXPECT_EQ(file.resolve("high")->gnss.rate_hz, 5.0);
  EXPECT_EQ(file.resolve("low")->gnss.rate_hz, 4.0);
  EXPECT_EQ(file.resolve("low")->gnss.model, "truth_plus_isotropic");
  EXPECT_EQ(file.resolve("high")->gnss.model, "pseudorange");
  file.set_option("gnss.rate_hz", ConfigNode::of(1.0), "--rate");
  EXPECT_EQ(file.resolve("low")->gnss.rate_hz, 1.0);
}

TEST(MissionFile, MixedRunsTakeTheImuAndItsAlignmentFromTheOther) {
  const MissionFile file = parse("base = \"vicksburg\"\n");
  const auto mixed = file.resolve_mixed("high", "low");
  EXPECT_EQ(mixed->gnss.model, "pseudorange");
  EXPECT_EQ(mixed->imu.errors, "white_only");
  EXPECT_EQ(mixed->run.initial_attitude_error_deg, Eigen::Vector3d::Zero());
}

TEST(MissionFile, AFidelityOfOnesOwn) {
  const MissionFile file = parse("base = \"vicksburg\"\n[fidelity.mine.gnss]\nmode = \"single\"\n");
  EXPECT_EQ(file.resolve("mine")->gnss.mode, "single");
  EXPECT_EQ(file.resolve("nobody").error().str(),
            "my.toml: fidelity.nobody: unknown fidelity, expected one of high, low, paper, mine");
}

TEST(MissionFileMessages, UnknownKeyNamesTheNearest) {
  EXPECT_THAT(message("base = \"vicksburg\"\n[gnss]\nrate_hzz = 2.0\n"),
              ::testing::AllOf(HasSubstr("my.toml:3: gnss.rate_hzz: "), HasSubstr("\"rate_hz\"")));
}

TEST(MissionFileMessages, ValueOutOfRange) {
  EXPECT_THAT(message("base = \"vicksburg\"\n[gnss]\n\nmask_deg = 95.0\n"), HasSubstr("my.toml:4: gnss.mask_deg: "));
}

TEST(MissionFileMessages, MalformedToml) {
  EXPECT_THAT(message("[gnss\nrate_hz = 2.0\n"), HasSubstr("my.toml:1: "));
}

TEST(MissionFileMessages, UnknownBase) {
  EXPECT_EQ(message("base = \"atlantis\"\n"),
            "my.toml:1: base: string \"atlantis\" is not a built-in mission, expected one of vicksburg");
}

TEST(MissionFileMessages, NoWaypoints) {
  EXPECT_EQ(message("[scene]\nempty = true\n"),
            "my.toml: autonomy.waypoint: no waypoints, expected at least one [[autonomy.waypoint]]");
}

TEST(MissionFileMessages, WaypointOutsideTheScene) {
  EXPECT_THAT(message(std::string(kEmptyScene) + "[[autonomy.waypoint]]\nname = \"far\"\np_m = [5000.0, 0.0]\n"),
              HasSubstr("my.toml:4: autonomy.waypoint[1]: (5000.0, 0.0) lies outside the scene, expected x from -500"));
}

TEST(MissionFileMessages, WaypointInsideABuilding) {
  EXPECT_THAT(message("base = \"vicksburg\"\n[[autonomy.waypoint]]\nname = \"in\"\np_m = [278.0, 43.3]\n"),
              HasSubstr("my.toml:2: autonomy.waypoint[1]: (278.0, 43.3) lies inside building 247, expected a place "
                        "outside buildings"));
}

TEST(MissionFileMessages, UnknownBuilding) {
  EXPECT_THAT(message("base = \"vicksburg\"\n[[autonomy.waypoint]]\nname = \"x\"\np_m = [213.9, 100.0]\nobserve = "
                      "\"buildin 247\"\n"),
              HasSubstr("my.toml:2: autonomy.waypoint[1]: no building named \"buildin 247\""));
}

TEST(MissionFileMessages, RatesMustDivide) {
  EXPECT_EQ(
      message(std::string(kEmptyScene) + "[gnss]\nrate_hz = 3.0\n"),
      "my.toml:5: gnss.rate_hz: 3 Hz does not divide the IMU's 100 Hz, expected imu.rate_hz divided by a whole number");
}

TEST(MissionFileMessages, BadStart) {
  EXPECT_THAT(message(std::string(kEmptyScene) + "[time]\nstart = \"yesterday\"\n"),
              HasSubstr("my.toml:5: time.start: "));
}

TEST(MissionFileMessages, MissingNavigationFile) {
  EXPECT_THAT(message(std::string(kEmptyScene) + "[gnss]\nnav_file = \"no/such.10n\"\n"), HasSubstr("no/such.10n"));
}

TEST(MissionFileMessages, MissingMissionFile) {
  EXPECT_THAT(MissionFile::load("no/such.toml").error().str(), HasSubstr("no/such.toml"));
}

}  // namespace
}  // namespace canyon::mission
