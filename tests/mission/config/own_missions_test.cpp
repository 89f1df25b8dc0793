// The missions of missions/ that bring a scene of their own.
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

// Each is read and checked, and its first twelve seconds are driven.
TEST(OwnMissions, EachBeginsToDrive) {
  for (const char* name : kOwnMissions) {
    MissionConfig config = own_mission(name, "low");
    config.time.limit_s = 12.0;
    const RecordedRun run = drive(config);
    EXPECT_EQ(run.outcome, Outcome::kStopped) << name << ": " << (run.failure ? run.failure->detail : "");
    EXPECT_GT(run.distance_m, 10.0) << name;
  }
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
