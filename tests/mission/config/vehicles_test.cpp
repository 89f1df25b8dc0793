// A vehicle of the catalogue in a mission.
#include <algorithm>

#include <gtest/gtest.h>

#include "canyon/core/config/config.h"
#include "canyon/core/process/embedded.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/config/vehicle_catalogue.h"
#include "canyon/mission/motion/plan/dynamic_bicycle.h"
#include "canyon/tests/support/temporary_folder.h"

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

/// A folder with a mission that names a vehicle's file beside it, and that file: the Husky's with one text replaced.
struct MissionWithVehicle {
  MissionWithVehicle(const std::string& named, const std::string& replaced, const std::string& by) {
    std::string vehicle(*embedded_file("mission/vehicles/husky_a200.toml"));
    vehicle.replace(vehicle.find(replaced), replaced.size(), by);
    canyon::testing::write(folder.file("mine.toml"), vehicle);
    canyon::testing::write(folder.file("m.toml"), "base = \"vicksburg\"\n[vehicle]\npreset = \"" + named +
                                                      "\"\nwidth_m = 0.75\n[scene]\nempty = true\n[autonomy]\n"
                                                      "cruise_m_s = 0.8\n");
  }
  Result<MissionConfig> config() const {
    const auto file = MissionFile::load(folder.file("m.toml"));
    if (!file.ok()) return file.error();
    return file->resolve("low");
  }
  canyon::testing::TemporaryFolder folder;
};

TEST(MissionVehicles, AFileBesideTheMissionIsAVehicleToo) {
  const MissionWithVehicle mine("mine.toml", "\nwheelbase_m = 0.512\n", "\nwheelbase_m = 0.6\n");
  const auto config = mine.config();
  ASSERT_TRUE(config.ok()) << config.error().str();
  EXPECT_EQ(config->vehicle.model.name, "skid_steer");
  EXPECT_EQ(config->vehicle.wheelbase_m, 0.6) << "its own";
  EXPECT_EQ(config->vehicle.length_m, 0.99) << "the Husky's";
  EXPECT_EQ(config->vehicle.width_m, 0.75) << "what stands beside its name";
  EXPECT_EQ(config->vehicle.start_m, with_vehicle("")->vehicle.start_m) << "the mission's own";
  SceneCache scenes;
  const auto mission = prepare(*config, scenes);
  ASSERT_TRUE(mission.ok()) << mission.error().str();
  const std::string path = mine.folder.file("mine.toml");
  EXPECT_TRUE(std::any_of(mission->files.begin(), mission->files.end(), [&](const InputFile& file) {
    return file.path == path;
  })) << "it is among the files that the manifest lists";
}

TEST(MissionVehicles, AWrongFileBesideTheMissionIsToldWithItsPlace) {
  const MissionWithVehicle absent("yours.toml", "\nwheelbase_m = ", "\nwheelbase_m = ");
  EXPECT_EQ(absent.config().error().str(),
            absent.folder.file("m.toml") + ":3: vehicle.preset: \"" + absent.folder.file("yours.toml") +
                "\" cannot be read (No such file or directory), expected a readable file");
}

TEST(MissionVehicles, AMistakeInAFileBesideTheMissionIsToldWithItsLine) {
  const MissionWithVehicle misspelt("mine.toml", "\nwheelbase_m = ", "\nweelbase_m = ");
  EXPECT_EQ(
      misspelt.config().error().str(),
      misspelt.folder.file("mine.toml") + ":31: weelbase_m: is not a figure of a vehicle, expected \"wheelbase_m\"?");
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
