// Every vehicle of the catalogue drives: around a corner of a street, told where it is, its whole body held against
// what stands there.
#include "canyon/mission/config/vehicle_catalogue.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::mission::testing {
namespace {

class VehiclesDrive : public ::testing::TestWithParam<std::string> {};

TEST_P(VehiclesDrive, AroundACorner) {
  const std::string slow = GetParam() == "husky_a200" ? "cruise_m_s = 0.9\n" : "";  // it drives at most 1 m/s
  const auto file = MissionFile::parse(R"(
base = "vicksburg"
[vehicle]
preset = ")" + GetParam() + R"("
start_m = [213.9, 70.0]
start_heading_deg = 0.0
[registration]
method = "none"
[lidar]
azimuth_steps = 600
rate_hz = 5.0
[run]
truth_as_pose = true
[success]
collision = "box"
[autonomy]
)" + slow + R"([[autonomy.waypoint]]
name = "crossing"
p_m = [213.9, 109.9]
[[autonomy.waypoint]]
name = "goal"
p_m = [185.0, 109.9]
)",
                                       "corner.toml");
  ASSERT_TRUE(file.ok()) << file.error().str();
  const auto config = file->resolve("low");
  ASSERT_TRUE(config.ok()) << config.error().str();
  const RecordedRun run = drive(*config);
  EXPECT_EQ(run.outcome, Outcome::kSuccess) << (run.failure ? run.failure->detail : "");
}

INSTANTIATE_TEST_SUITE_P(Presets, VehiclesDrive, ::testing::ValuesIn(vehicle_names()),
                         [](const auto& preset) { return preset.param; });

}  // namespace
}  // namespace canyon::mission::testing
