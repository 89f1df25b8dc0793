// Plans of six scenes, replayed with and without what they leave out: at least 5,000 epochs in all, and not one differs
// by more than its bound.
#include <cstdio>
#include <filesystem>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/math/median.h"
#include "canyon/mission/route_tape.h"
#include "canyon/study/plan/plan.h"
#include "canyon/study/plan/verify.h"
#include "canyon/tests/mission/short_mission.h"
#include "canyon/tests/support/outside_program.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::study {
namespace {

constexpr std::int64_t kEpochs = 300;  // of each kind, in each scene and plan

/// What is verified of a scene: a plan for driving, and one for positions within 5 cm on a tape.
struct SceneVerified {
  std::int64_t epochs = 0, violations = 0;
  std::vector<double> tightness;
};

SceneVerified verify_scene(const std::string& name, const mission::MissionConfig& config) {
  SceneVerified sum;
  const auto mission = mission::prepare(config, mission::testing::scenes());
  EXPECT_TRUE(mission.ok()) << name << ": " << mission.error().str();
  if (!mission.ok()) return sum;
  const auto tape = mission::drive_route(config, *mission);
  EXPECT_TRUE(tape.ok()) << name;
  const PlanRequest driving{.fidelity = "high", .outputs = {Output::kOutcome, Output::kPosition}};
  const PlanRequest placing{.fidelity = "high",
                            .outputs = {Output::kPosition},
                            .open_loop = true,
                            .tolerances = {{"position_error_rms_m", 0.05}}};
  for (const PlanRequest& request : {driving, placing}) {
    const auto plan = make_plan(config, *mission, request);
    EXPECT_TRUE(plan.ok()) << name;
    const auto found = verify_plan(config, *mission, *tape, *plan, kEpochs);
    EXPECT_TRUE(found.ok()) << name << ": " << found.error().str();
    if (!found.ok()) continue;
    for (const VerifiedEffect& effect : found->effects) {
      EXPECT_EQ(effect.violations, 0) << name << ", " << effect.effect << ": " << effect.largest_difference << " of "
                                      << effect.bound;
      if (!effect.of_position && effect.bound > 0.0 && effect.largest_difference > 0.0)
        sum.tightness.push_back(effect.bound / effect.largest_difference);
    }
    sum.epochs += found->epochs();
    sum.violations += found->violations();
    std::printf("%-10s %-8s %6lld epochs, %lld violations, tightness %.1f, of positions %.1f\n", name.c_str(),
                request.open_loop ? "position" : "driving", static_cast<long long>(found->epochs()),
                static_cast<long long>(found->violations()), found->tightness(), found->position_tightness());
  }
  return sum;
}

mission::MissionConfig resolved(const Result<mission::MissionFile>& file) {
  EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().str());
  const auto config = file->resolve("high");
  EXPECT_TRUE(config.ok()) << (config.ok() ? "" : config.error().str());
  return *config;
}

mission::MissionConfig built_in(const std::string& extra) {
  return resolved(mission::MissionFile::parse("base = \"vicksburg\"\n" + extra, "built_in.toml"));
}

/// Eight houses of 20 x 12 m on either side of 180 m of street, 18 m from front to front, 7 to 13 m high; as GeoJSON.
std::string street_of_houses() {
  const auto at = [](double x, double y) {
    char text[64];
    std::snprintf(text, sizeof text, "[%.8f, %.8f]", -90.88 + x / 94140.0, 32.35 + y / 110900.0);
    return std::string(text);
  };
  std::string features;
  const auto house = [&](double x, double y, int height_m) {
    features += R"({"type": "Feature", "properties": {"height": )" + std::to_string(height_m) +
                R"(}, "geometry": {"type": "Polygon", "coordinates": [[)" + at(x, y) + ", " + at(x + 20, y) + ", " +
                at(x + 20, y + 12) + ", " + at(x, y + 12) + ", " + at(x, y) + "]]}},\n";
  };
  for (int k = 0; k < 8; ++k) {
    house(-100.0 + 25.0 * k, 9.0, 8 + 2 * (k % 3));
    house(-95.0 + 25.0 * k, -21.0, 7 + 3 * (k % 3));
  }
  features += R"({"type": "Feature", "properties": {}, "geometry": {"type": "LineString", "coordinates": [)" +
              at(-100, 0) + ", " + at(100, 0) + "]}}";
  return R"({"type": "FeatureCollection", "features": [)" + features + "]}";
}

constexpr const char* kThroughTheStreet = R"(
[run]
name = "street"
[scene]
file = "street.geojson"
undulation_m = 0.0
[vehicle]
start_m = [-80.0, 0.0]
start_heading_deg = 90.0
[[autonomy.waypoint]]
name = "1"
p_m = [80.0, 0.0]
)";

// On the campus of its university, between buildings of up to 17 m.
constexpr const char* kThroughDelft = R"(
[run]
name = "delft"
[scene]
file = "data/delft.city.json"
undulation_m = 43.5
[vehicle]
start_m = [199.5, -81.1]
start_heading_deg = 315.0
[[autonomy.waypoint]]
name = "1"
p_m = [133.5, -15.1]
[[autonomy.waypoint]]
name = "2"
p_m = [73.5, 38.9]
)";

TEST(PlanNightly, NothingDiffersInSixScenes) {
  CANYON_REAL_DATA(shibuya, "scenes/shibuya/shibuya_buildings_lod1_epsg6668.geojson");
  CANYON_REAL_DATA(lyon, "scenes/lyon1/lyon1_buildings_wgs84.geojson");
  CANYON_REAL_DATA(delft, "scenes/delft/delft.city.json");
  namespace fs = std::filesystem;
  const canyon::testing::ScratchDirectory scratch;
  const auto beside = [&](const std::string& folder, const std::string& data, const std::string& text) {
    const fs::path at = scratch.file(folder);
    fs::create_directories(at);
    if (!data.empty()) fs::create_symlink(fs::absolute(data).parent_path(), at / "data");
    EXPECT_TRUE(write_text_file((at / "mission.toml").string(), text).ok());
    return at;
  };
  const auto delivery = [](const char* name) {
    return *read_text_file((fs::path(CANYON_SOURCE_DIR) / "missions/delivery" / name).string());
  };
  const fs::path street = beside("street", "", kThroughTheStreet);
  ASSERT_TRUE(write_text_file((street / "street.geojson").string(), street_of_houses()).ok());
  const auto in = [](const fs::path& folder) {
    return resolved(mission::MissionFile::load((folder / "mission.toml").string()));
  };
  const std::pair<std::string, mission::MissionConfig> scenes[] = {
      {"built-in", built_in("[time]\nlimit_s = 90.0\n")},
      {"field", built_in("[time]\nlimit_s = 90.0\n[scene]\nempty = true\n")},
      {"street", in(street)},
      {"shibuya", in(beside("shibuya", shibuya, delivery("shibuya.toml")))},
      {"lyon", in(beside("lyon", lyon, delivery("lyon.toml")))},
      {"delft", in(beside("delft", delft, kThroughDelft))}};
  SceneVerified all;
  for (const auto& [name, config] : scenes) {
    const SceneVerified one = verify_scene(name, config);
    EXPECT_GE(one.epochs, 2 * kEpochs) << name;
    all.epochs += one.epochs;
    all.tightness.insert(all.tightness.end(), one.tightness.begin(), one.tightness.end());
  }
  std::printf("%lld epochs in all, median tightness %.1f\n", static_cast<long long>(all.epochs), median(all.tightness));
  EXPECT_GE(all.epochs, 5000);
  EXPECT_LE(median(all.tightness), 10.0);
}

}  // namespace
}  // namespace canyon::study
