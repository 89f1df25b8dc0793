// The missions of missions/ that bring a scene of their own, and those that are the beginning of the built-in one.
#include <cstdio>

#include "canyon/tests/mission/short_mission.h"
#include "canyon/tests/mission/summary_of.h"

namespace canyon::mission::testing {
namespace {

const char* const kOwnMissions[] = {"open_field/survey", "underpass/underpass", "forest_track/forest_track",
                                    "parking_lot/circle", "parking_lot/line"};

MissionConfig own_mission(const std::string& name, const std::string& fidelity) {
  const auto file = MissionFile::load(std::string(CANYON_SOURCE_DIR) + "/missions/" + name + ".toml");
  EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().str());
  auto config = file->resolve(fidelity);
  EXPECT_TRUE(config.ok()) << (config.ok() ? "" : config.error().str());
  config->registration.method.name = "none";
  return *config;
}

/// It is checked, and its first twelve seconds are driven.
void expect_begins_to_drive(const std::string& name, MissionConfig config) {
  config.time.limit_s = 12.0;
  const RecordedRun run = drive(config);
  EXPECT_EQ(run.outcome, Outcome::kStopped) << name << ": " << (run.failure ? run.failure->detail : "");
  EXPECT_GT(run.distance_m, 10.0) << name;
}

TEST(OwnMissions, EachBeginsToDrive) {
  for (const char* name : kOwnMissions) expect_begins_to_drive(name, own_mission(name, "low"));
}

// At `high`, as their outcomes are told: the first five and the first seven waypoints, of which the last is looked at.
TEST(OwnMissions, FirstCornerAndFirstStopBeginAsTheBuiltInMission) {
  const MissionConfig whole = own_mission("vicksburg", "high");
  for (const auto& [name, count] : {std::pair("first_corner", 5U), std::pair("first_stop", 7U)}) {
    const MissionConfig config = own_mission(name, "high");
    EXPECT_EQ(config.run.name, name);
    ASSERT_EQ(config.autonomy.waypoints.size(), count) << name;
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(config.autonomy.waypoints[i].p_m, whole.autonomy.waypoints[i].p_m) << name << " " << i + 1;
      EXPECT_EQ(config.autonomy.waypoints[i].observe, whole.autonomy.waypoints[i].observe) << name << " " << i + 1;
      EXPECT_EQ(config.autonomy.waypoints[i].is_mission(), i == 6) << name << " " << i + 1;
    }
    expect_begins_to_drive(name, config);
  }
}

// Pavements raised, the lane between their kerbs.
TEST(OwnMissions, TheBuiltInStreetWithKerbsBeginsToBeDriven) {
  const auto file = MissionFile::parse(
      "base = \"vicksburg\"\n[scene]\nkerb_height_m = 0.12\n[autonomy.lane]\nmodel = \"seen_kerbs\"\n", "kerbs.toml");
  ASSERT_TRUE(file.ok()) << file.error().str();
  auto config = file->resolve("low");
  ASSERT_TRUE(config.ok()) << config.error().str();
  config->registration.method.name = "none";
  config->time.limit_s = 12.0;
  const RecordedRun run = drive(*config);
  EXPECT_EQ(run.outcome, Outcome::kStopped) << (run.failure ? run.failure->detail : "");
  EXPECT_GT(run.distance_m, 10.0);
}

// Laps and passes are the paper's: 60 foot across, eight times round; 60 foot, ten times.
TEST(OwnMissions, TheParkingLotsTracksAreThePapers) {
  const auto circle = prepare(own_mission("parking_lot/circle", "low"), scenes());
  ASSERT_TRUE(circle.ok()) << circle.error().str();
  constexpr double kFoot_m = 0.3048;
  // Of 24 corners, rounded: shorter than the circle by less than 1 %.
  EXPECT_NEAR(circle->prior.route.length_m() / (8.0 * kPi * 60.0 * kFoot_m), 1.0, 0.01);
  const auto line = prepare(own_mission("parking_lot/line", "low"), scenes());
  ASSERT_TRUE(line.ok()) << line.error().str();
  double straight_m = 0.0;
  for (double s = 0.0; s < line->prior.route.length_m(); s += 0.1)
    if (std::abs(line->prior.route.at(s).y()) < 0.3 && std::abs(line->prior.route.at(s).x()) < 30.0 * kFoot_m)
      straight_m += 0.1;
  EXPECT_NEAR(straight_m, 600.0 * kFoot_m, 10.0);
}

TEST(OwnMissionsNightly, EachIsDrivenLowAndHigh) {
  for (const char* name : kOwnMissions)
    for (const char* fidelity : {"low", "high"}) {
      const study::RunSummary run = summary_of(drive(own_mission(name, fidelity)));
      std::printf("  %-26s %-4s %s%s%s; %.0f m in %.0f s, position %.2f m rms\n", name, fidelity,
                  mission::name(*run.outcome), run.failure ? ": " : "", run.failure ? run.failure->detail.c_str() : "",
                  run.distance_m, run.duration_s, run.position_m.rms);
      if (std::string(fidelity) == "low") {
        EXPECT_EQ(run.outcome, Outcome::kSuccess) << name;
      }
    }
}

}  // namespace
}  // namespace canyon::mission::testing
