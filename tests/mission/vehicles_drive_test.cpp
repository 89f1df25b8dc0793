// Every vehicle of the catalogue drives: around a corner of a street, told where it is, its whole body held against
// what stands there.
#include "canyon/mission/config/vehicle_catalogue.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

class VehiclesDrive : public ::testing::TestWithParam<std::string> {};

/// How it ends for a vehicle of these keys, its body held against all that stands there.
std::string around_a_corner(const std::string& vehicle, const std::string& autonomy) {
  const auto file = MissionFile::parse(R"(
base = "vicksburg"
[vehicle]
)" + vehicle + R"(
start_m = [213.9, 70.0]
start_heading_deg = 0.0
[registration]
method = "none"
[lidar]
azimuth_steps = 600
rate_hz = 5.0
[run]
truth_as_pose = true
[autonomy]
)" + autonomy + R"(
[[autonomy.waypoint]]
name = "crossing"
p_m = [213.9, 109.9]
[[autonomy.waypoint]]
name = "goal"
p_m = [185.0, 109.9]
)",
                                       "corner.toml");
  if (!file) return file.error().str();
  const auto config = file->resolve("low");
  if (!config) return config.error().str();
  const RecordedRun run = drive(*config);
  return name(run.outcome.value()) + (run.failure ? ": " + run.failure->detail : std::string());
}

TEST_P(VehiclesDrive, AroundACorner) {
  const std::string slow = GetParam() == "husky_a200" ? "cruise_m_s = 0.9" : "";  // it drives at most 1 m/s
  EXPECT_EQ(around_a_corner("preset = \"" + GetParam() + "\"", slow), "success");
}

// 2026-11-30: told its true place, one that turns by no more than 8 degrees a second took the corner at a speed at
// which it could not, and hit a parked car.
TEST(VehiclesDriveSlowly, WhatTurnsSlowlySlowsDownForIt) {
  for (const char* most_deg_s : {"8", "20"})
    EXPECT_EQ(around_a_corner("model = \"skid_steer\"\nmax_turn_rate_deg_s = " + std::string(most_deg_s), ""),
              "success")
        << most_deg_s;
}

INSTANTIATE_TEST_SUITE_P(Presets, VehiclesDrive, ::testing::ValuesIn(vehicle_names()),
                         [](const auto& preset) { return preset.param; });

}  // namespace
}  // namespace canyon::mission::testing
