// A vehicle of the catalogue in a mission.
#include <gtest/gtest.h>

#include "canyon/core/config/config.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/config/vehicle_catalogue.h"
#include "canyon/mission/motion/plan/dynamic_bicycle.h"

namespace canyon::mission {
namespace {

std::string vehicle_keys(MissionConfig config) {
  return fields_as_json([&config](FieldVisitor& f) { visit(f, config.vehicle); });
}

Result<MissionConfig> with_vehicle(const std::string& vehicle) {
  const auto file = MissionFile::parse("base = \"vicksburg\"\n[vehicle]\n" + vehicle, "m.toml");
  if (!file.ok()) return file.error();
  return file->resolve("low");
}

TEST(MissionVehicles, EverySheetIsCompleteAndPossible) {
  const auto names = vehicle_names();
  EXPECT_GE(names.size(), 4u);
  for (const std::string& name : names) {
    const auto sheet = load_vehicle(name);
    ASSERT_TRUE(sheet.ok()) << sheet.error().str();
    EXPECT_EQ(sheet->name, name);
    EXPECT_EQ(sheet->sources.size(), sheet->figures.table()->size()) << name;
    const auto config = with_vehicle("preset = \"" + name + "\"\n");
    EXPECT_TRUE(config.ok()) << config.error().str();
  }
}

// To the bit: every key is the same, but the name.
TEST(MissionVehicles, TheScoutIsWhatTheKeysSayWithoutAPreset) {
  auto named = with_vehicle("preset = \"scout\"\n");
  ASSERT_TRUE(named.ok()) << named.error().str();
  named->vehicle.preset.clear();
  EXPECT_EQ(vehicle_keys(*named), vehicle_keys(*with_vehicle("")));
}

TEST(MissionVehicles, WhatStandsBesideTheNameOverrides) {
  const auto config = with_vehicle("preset = \"bmw_320i\"\ntyre_friction = 0.3\n");
  ASSERT_TRUE(config.ok()) << config.error().str();
  EXPECT_EQ(config->vehicle.model.name, "dynamic_bicycle");
  EXPECT_EQ(config->vehicle.model.own.get<DynamicBicycleParameters>().tyre_friction, 0.3);
  EXPECT_EQ(config->vehicle.wheelbase_m, 2.578);
  EXPECT_EQ(config->vehicle.start_m, with_vehicle("")->vehicle.start_m) << "the mission's own";
}

TEST(MissionVehicles, MistakesAreOneLineEach) {
  EXPECT_EQ(with_vehicle("preset = \"huskie_a200\"\n").error().str(),
            "m.toml:3: vehicle.preset: no vehicle \"huskie_a200\" in the catalogue, expected \"husky_a200\"?");
  const auto wrong = [](const std::string& toml) { return parse_vehicle(toml, "v.toml").error().str(); };
  EXPECT_EQ(wrong("weelbase_m = 1.0\n"),
            "v.toml:1: weelbase_m: is not a figure of a vehicle, expected \"wheelbase_m\"?");
  EXPECT_EQ(wrong("start_m = [0.0, 0.0]\n"),
            "v.toml:1: start_m: is not a figure of a vehicle, expected a key of [vehicle] that describes one");
  EXPECT_EQ(
      wrong("model = \"skid_steer\"\ntyre_friction = 0.9\n"),
      "v.toml:2: tyre_friction: is not of the model or the actuators that this vehicle has, expected it left out");
  EXPECT_NE(wrong("model = \"skid_steer\"\n").find("slip_track_ratio, slip_track_ratio_source"), std::string::npos);
  EXPECT_NE(wrong("model = \"hovercraft\"\n").find("v.toml:1: model: "), std::string::npos);
}

}  // namespace
}  // namespace canyon::mission
