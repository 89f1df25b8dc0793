// Waypoints that the vehicle's body cannot come to, and those that it can, though something stands there.
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/config/text.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/surfaces/material.h"
#include "canyon/scene/written_scene.h"
#include "canyon/tests/mission/config/mission_message.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::mission {
namespace {

using testing::kEmptyScene;
using testing::message;

/// A box that stands somewhere.
struct StandingThing {
  const char* name;
  scene::ObjectKind kind;
  Eigen::Vector3d middle, half;
};

enum class Alley { kNone, kOpen, kDeadEnd };

/// A street along x from -40 to 40 m; as an alley it is 2 m wide up to x = 28 m, between houses 4 m deep, and a dead
/// end is shut from x = 26 m on. The body is 1.5 m wide.
scene::SceneParts street_with(const StandingThing& thing, Alley alley) {
  scene::SceneParts parts;
  parts.name = "street";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  const std::uint16_t concrete = mesh.material("concrete");
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-80, -80, 0}, {80, -80, 0}, {80, 80, 0}, {-80, 80, 0}, concrete);
  const auto add = [&](const StandingThing& of) {
    const std::uint32_t object = mesh.begin_object(of.name, of.kind);
    mesh.box(of.middle, Eigen::Matrix3d::Identity(), of.half, concrete);
    if (of.kind != scene::ObjectKind::kBuilding) return;
    scene::Building building;
    building.name = of.name;
    building.object = object;
    const Eigen::Vector3d low = of.middle - of.half, high = of.middle + of.half;
    building.footprint_W = scene::rectangle(low.x(), low.y(), high.x(), high.y());
    building.height_m = high.z();
    parts.buildings.push_back(building);
  };
  add(thing);
  if (alley != Alley::kNone) {
    add({"left house", scene::ObjectKind::kBuilding, {-6.0, 3.0, 3.0}, {34.0, 2.0, 3.0}});
    add({"right house", scene::ObjectKind::kBuilding, {-6.0, -3.0, 3.0}, {34.0, 2.0, 3.0}});
  }
  if (alley == Alley::kDeadEnd) add({"end house", scene::ObjectKind::kBuilding, {27.0, 0.0, 3.0}, {1.0, 1.0, 3.0}});
  parts.streets.nodes_W = {{-40, 0}, {40, 0}};
  parts.streets.edges = {{0, 1, 8.0}};
  return parts;
}

/// What is said of a goal at x = 20 m that counts within such a radius.
std::string told_of_goal(const StandingThing& thing, Alley alley, double radius_m) {
  const canyon::testing::TemporaryFolder folder;
  EXPECT_TRUE(scene::write_scene(street_with(thing, alley), folder.path().string()).ok());
  return message("[scene]\nfile = \"" + folder.file("scene.json") +
                     "\"\n[vehicle]\nstart_m = [-30.0, 0.0]\nstart_heading_deg = 90.0\n[[autonomy.waypoint]]\nname = "
                     "\"goal\"\np_m = [20.0, 0.0]\n[success]\nwaypoint_radius_m = " +
                     number_text(radius_m) + "\n",
                 "low");
}

std::string is_in_the_way(const std::string& name, double radius_m) {
  return "my.toml:6: autonomy.waypoint[1]: waypoint \"goal\" at (20.0, 0.0): " + name +
         " stands in the way, and the body comes to no place within success.waypoint_radius_m = " +
         number_text(radius_m) + " m of it, expected a place that it can come to";
}

// Thicker than the lines through the body are apart, 0.375 m.
const StandingThing kLamp{"lamp 1", scene::ObjectKind::kPole, {20.0, 0.0, 1.5}, {0.4, 0.4, 1.5}};
const StandingThing kTrunk{"tree 1", scene::ObjectKind::kTree, {20.0, 0.0, 2.0}, {0.45, 0.45, 2.0}};
const StandingThing kParked{"vehicle 1", scene::ObjectKind::kVehicle, {20.0, 0.0, 0.75}, {2.25, 0.9, 0.55}};
const StandingThing kGate{"building 1", scene::ObjectKind::kBuilding, {18.0, 0.0, 2.0}, {1.0, 1.0, 2.0}};

// The rear axle is what comes to the goal, and it comes nearest in reverse: the rear bumper is 0.4 m behind it, 0.2 m
// of the smaller body that is held against what stands. Before the lamp's middle it stands 0.6 m then, the trunk's 0.65
// m, 2.45 m before the car's middle, and 3.2 m before a goal a metre behind the gate.
TEST(BlockedWaypoints, InADeadEndWhateverStandsIsInTheWay) {
  for (const StandingThing& thing : {kLamp, kTrunk, kParked, kGate})
    EXPECT_EQ(told_of_goal(thing, Alley::kDeadEnd, 0.4), is_in_the_way(thing.name, 0.4));
  EXPECT_EQ(told_of_goal(kParked, Alley::kDeadEnd, 2.0), is_in_the_way("vehicle 1", 2.0));
}

TEST(BlockedWaypoints, AFreePlaceWithinTheRadiusIsEnough) {
  // In reverse.
  EXPECT_EQ(told_of_goal(kLamp, Alley::kDeadEnd, 0.8), "no mistake");
  EXPECT_EQ(told_of_goal(kParked, Alley::kDeadEnd, 3.0), "no mistake");
  EXPECT_EQ(told_of_goal(kLamp, Alley::kDeadEnd, 2.6), "no mistake");
  EXPECT_EQ(told_of_goal(kGate, Alley::kDeadEnd, 4.0), "no mistake");
  EXPECT_EQ(told_of_goal(kParked, Alley::kDeadEnd, 4.8), "no mistake");
  EXPECT_EQ(told_of_goal(kParked, Alley::kDeadEnd, 100.0), "no mistake") << "from where it starts it is there";
}

// Beyond the lamp the axle stands 0.8 m from its middle: the other end of the alley leads there. Beside a parked car it
// stands 1.65 m from its middle.
TEST(BlockedWaypoints, AnotherWayThereIsEnough) {
  EXPECT_EQ(told_of_goal(kLamp, Alley::kOpen, 0.8), "no mistake");
  EXPECT_EQ(told_of_goal(kLamp, Alley::kNone, 0.9), "no mistake");
  EXPECT_EQ(told_of_goal(kParked, Alley::kNone, 2.0), "no mistake");
  EXPECT_EQ(told_of_goal(kParked, Alley::kNone, 0.8), is_in_the_way("vehicle 1", 0.8));
}

/// A taxi and a goal at (213.9, 150), 90 m up an empty street, that the vehicle reaches after 15 s at the soonest.
std::string told_of_taxi(const std::string& path_and_times, double radius_m = 0.8) {
  return message(std::string(kEmptyScene) + "[[scene.moving]]\nname = \"taxi\"\npath_m = " + path_and_times +
                 "\n[vehicle]\nstart_m = [213.9, 60.0]\nstart_heading_deg = 0.0\n[[autonomy.waypoint]]\nname = "
                 "\"north\"\np_m = [213.9, 150.0]\n[success]\nwaypoint_radius_m = " +
                 number_text(radius_m) + "\n");
}

std::string taxi_at_line(int line) {
  return "my.toml:" + std::to_string(line) +
         ": autonomy.waypoint[1]: waypoint \"north\" at (213.9, 150.0): taxi stands in the way, and the body comes to "
         "no place within success.waypoint_radius_m = 0.8 m of it, expected a place that it can come to";
}

TEST(BlockedWaypoints, AMovingThingThatEndsItsWayThere) {
  EXPECT_EQ(told_of_taxi("[213.9, 100.0, 213.9, 150.0]"), taxi_at_line(10));
  EXPECT_EQ(told_of_taxi("[213.9, 150.0, 213.9, 151.0]\nstart_s = 1e5"), taxi_at_line(11)) << "it never starts";
  EXPECT_EQ(told_of_taxi("[213.9, 150.0]"), taxi_at_line(10)) << "it has no way";
}

TEST(BlockedWaypoints, AMovingThingThatMayBePassed) {
  EXPECT_EQ(told_of_taxi("[213.9, 100.0, 213.9, 150.0]", 3.0), "no mistake") << "beside it there is room";
  EXPECT_EQ(told_of_taxi("[230.0, 150.0, 213.9, 150.0]\nstart_s = 20.0"), "no mistake") << "it comes there later";
  EXPECT_EQ(told_of_taxi("[213.9, 150.0, 230.0, 150.0]"), "no mistake") << "it leaves";
}

// A coach stands across the built-in mission's first waypoint, in the empty city: the mistake is in what the user
// wrote.
TEST(BlockedWaypoints, OfAnInheritedWaypointTheThingIsNamed) {
  EXPECT_EQ(message(std::string(kEmptyScene) +
                    "[[scene.moving]]\nname = \"coach\"\nshape = \"bus\"\npath_m = [112.9, -187.9]\n[autonomy]\n"
                    "corner_radius_m = 2.9\n[success]\nwaypoint_radius_m = 1.25\n"),
            "my.toml:4: scene.moving[1].path_m: waypoint \"1\" at (112.9, -187.9): coach stands in the way, and the "
            "body comes to no place within success.waypoint_radius_m = 1.25 m of it, expected a place that it can come "
            "to");
}

/// Files of missions/ and examples/ that are missions, without those that need a city's files.
std::vector<std::string> mission_files() {
  const std::filesystem::path root(CANYON_SOURCE_DIR);
  std::vector<std::string> files;
  for (const char* folder : {"missions", "examples"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::string name = entry.path().filename().string();
      const bool is_none =
          name == "fidelities.toml" || name == "imu_vibration.toml" || name == "rtklib_equivalent.toml";
      const bool needs_data = entry.path().parent_path().filename() == "delivery";
      if (entry.path().extension() == ".toml" && !is_none && !needs_data) files.push_back(entry.path().string());
    }
  return files;
}

TEST(BlockedWaypoints, NoMissionThatComesWithTheProgramIsRefused) {
  const auto files = mission_files();
  EXPECT_GE(files.size(), 11U);
  SceneCache scenes;
  for (const std::string& path : files) {
    const auto file = MissionFile::load(path);
    ASSERT_TRUE(file.ok()) << file.error().str();
    for (const char* fidelity : {"low", "high"}) {
      const auto config = file->resolve(fidelity);
      ASSERT_TRUE(config.ok()) << config.error().str();
      const auto mission = prepare(*config, scenes);
      EXPECT_TRUE(mission.ok()) << file->locate(mission.error(), fidelity).str();
    }
  }
}

}  // namespace
}  // namespace canyon::mission
