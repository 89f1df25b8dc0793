// Messages about waypoints and streets that are not where a mission can drive.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/config/text.h"
#include "canyon/core/files/files.h"
#include "canyon/scene/city/site.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/surfaces/material.h"
#include "canyon/scene/written_scene.h"
#include "canyon/tests/mission/config/mission_message.h"
#include "canyon/tests/support/process_cpu.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::mission {
namespace {

using ::testing::HasSubstr;
using testing::kEmptyScene;
using testing::message;
using testing::parse;

TEST(MissionFileMessages, NoWaypoints) {
  EXPECT_EQ(message("[scene]\nempty = true\n"),
            "my.toml: autonomy.waypoint: no waypoints, expected at least one [[autonomy.waypoint]]");
}

TEST(MissionFileMessages, WaypointOutsideTheScene) {
  EXPECT_THAT(message(std::string(kEmptyScene) + "[[autonomy.waypoint]]\nname = \"far\"\np_m = [5000.0, 0.0]\n"),
              HasSubstr("my.toml:4: autonomy.waypoint[1]: waypoint \"far\" at (5000.0, 0.0) lies outside the scene, "
                        "expected x from -500"));
}

TEST(MissionFileMessages, WaypointInsideABuilding) {
  EXPECT_THAT(message("base = \"vicksburg\"\n[[autonomy.waypoint]]\nname = \"in\"\np_m = [278.0, 43.3]\n"),
              HasSubstr("my.toml:2: autonomy.waypoint[1]: waypoint \"in\" at (278.0, 43.3) lies inside building 247, "
                        "expected a place "
                        "outside buildings"));
}

// 2026-11-22: accepted, routed to its foot point on the street, and then out of reach for good.
TEST(MissionFileMessages, AWaypointThatNoStreetPassesNearEnough) {
  const std::string waypoint = "[[autonomy.waypoint]]\nname = \"yard\"\np_m = [213.9, 150.0]\n";
  EXPECT_EQ(message(std::string(kEmptyScene) + waypoint), "no mistake");
  const std::string yard = "[[autonomy.waypoint]]\nname = \"yard\"\np_m = [243.9, 150.0]\n";
  EXPECT_EQ(
      message(std::string(kEmptyScene) + yard),
      "my.toml:4: autonomy.waypoint[1]: waypoint \"yard\" at (243.9, 150.0) lies 30.0 m from the nearest street's "
      "centre line, expected a place within success.waypoint_radius_m = 3 m of one");
  EXPECT_EQ(message(std::string(kEmptyScene) + yard + "[success]\nwaypoint_radius_m = 31.0\n"), "no mistake");
}

/// The crossing of the built-in city nearest to a point, to the last digit, as TOML.
std::string crossing(double x, double y) {
  const auto nodes = scene::planned_site({})->streets.nodes_W;
  const Eigen::Vector2d p(x, y);
  const auto nearest = std::min_element(nodes.begin(), nodes.end(),
                                        [&](const auto& a, const auto& b) { return (a - p).norm() < (b - p).norm(); });
  return "[" + number_text(nearest->x()) + ", " + number_text(nearest->y()) + "]";
}

// A corner that is rounded too much is as far away: 20 m (sqrt(2) - 1) = 8.3 m.
TEST(MissionFileMessages, AWaypointThatTheRoundedRouteCutsOff) {
  const std::string corner =
      "[vehicle]\nstart_m = [213.9, 60.0]\n[[autonomy.waypoint]]\nname = \"corner\"\np_m = " + crossing(213.9, 109.9) +
      "\n[[autonomy.waypoint]]\nname = \"west\"\np_m = [150.0, 109.9]\n";
  EXPECT_EQ(message(std::string(kEmptyScene) + corner), "no mistake");
  EXPECT_EQ(
      message(std::string(kEmptyScene) + corner + "[autonomy]\ncorner_radius_m = 20.0\n"),
      "my.toml:6: autonomy.waypoint[1]: the route, its corners rounded, passes waypoint \"corner\" at a distance of "
      "8.3 m, expected at most success.waypoint_radius_m = 3 m: a place off the corner, or a smaller "
      "autonomy.corner_radius_m");
}

// 2026-11-22: ended the program: a route without length has no points to be on.
TEST(MissionFileMessages, AWayWithoutLength) {
  const std::string here = crossing(213.9, 109.9);
  EXPECT_EQ(message(std::string(kEmptyScene) + "[vehicle]\nstart_m = " + here +
                    "\n[[autonomy.waypoint]]\nname = \"here\"\np_m = " + here + "\n"),
            "my.toml:6: autonomy.waypoint[1]: start and waypoints are one place, expected a way to drive");
}

/// Level ground with two streets along x, 30 m apart; `joined`: with a third between their eastern ends.
scene::SceneParts two_streets(bool joined) {
  scene::SceneParts parts;
  parts.name = "two streets";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-80, -80, 0}, {80, -80, 0}, {80, 80, 0}, {-80, 80, 0}, mesh.material("asphalt"));
  parts.streets.nodes_W = {{-40, 0}, {40, 0}, {-40, 30}, {40, 30}};
  parts.streets.edges = {{0, 1, 8.0}, {2, 3, 8.0}};
  if (joined) parts.streets.edges.push_back({1, 3, 8.0});
  return parts;
}

TEST(MissionFileMessages, AWaypointThatNoStreetLeadsTo) {
  const canyon::testing::TemporaryFolder folder;
  const auto told = [&](bool joined) {
    EXPECT_TRUE(scene::write_scene(two_streets(joined), folder.path().string()).ok());
    return message("[scene]\nfile = \"" + folder.file("scene.json") +
                       "\"\n[vehicle]\nstart_m = [-30.0, 0.0]\n[[autonomy.waypoint]]\nname = \"near\"\np_m = [0.0, "
                       "0.0]\n[[autonomy.waypoint]]\nname = \"far\"\np_m = [0.0, 30.0]\n",
                   "low");
  };
  EXPECT_EQ(
      told(false),
      "my.toml:8: autonomy.waypoint[2]: no street leads to waypoint \"far\", expected a waypoint that the streets "
      "connect with the one before");
  EXPECT_EQ(told(true), "no mistake");
}

// The vehicle heads east: its bumper is 2.2 m before its rear axle, and the car's back 2.25 m behind the car's middle.
TEST(MissionFileMessages, AStartWhereSomethingStands) {
  const auto told = [](const std::string& way) {
    return message(std::string(kEmptyScene) + "[[scene.moving]]\nname = \"taxi\"\npath_m = " + way +
                   "\n[vehicle]\nstart_m = [213.9, 60.0]\nstart_heading_deg = 90.0\n[[autonomy.waypoint]]\nname = "
                   "\"north\"\np_m = [213.9, 150.0]\n");
  };
  EXPECT_EQ(told("[218.2, 60.0]"),
            "my.toml:8: vehicle.start_m: (213.9, 60.0): the body touches taxi there, expected a place where it stands "
            "free");
  EXPECT_EQ(told("[218.5, 60.0]"), "no mistake");
  EXPECT_EQ(told("[230.0, 60.0, 213.9, 60.0]"), "no mistake") << "it comes there later";
}

// 2026-11-22: the vehicle drove there, stopped, and only then was it told that it sees nothing.
TEST(MissionFileMessages, AFacadeOutOfSightFromItsStop) {
  const std::string stop =
      "base = \"vicksburg\"\n[vehicle]\nstart_m = [213.9, 30.0]\n[[autonomy.waypoint]]\nname = \"house\"\np_m = "
      "[213.9, 150.0]\nobserve = ";
  EXPECT_EQ(message(stop + "\"building 273\"\n"), "no mistake");
  EXPECT_THAT(message(stop + "\"building 1\"\n"),
              ::testing::MatchesRegex("my.toml:4: autonomy.waypoint.1.: waypoint \"house\": from its stop at .213.9, "
                                      "150.0. [0-9.]+ % of the facade of building 1 is in sight, expected at least "
                                      "success.facade_share = 0.5"));
  EXPECT_EQ(message(stop + "\"building 1\"\n[success]\nfacade_share = 0.0\n"), "no mistake");
}

// 2026-11-22: told after 84 s, when 36 million terrain corners and their triangles had been made. Without them it takes
// 0.03 s of CPU time; 2 s leave room for sanitizers.
TEST(MissionFileMessages, AMisplacedWaypointIsToldBeforeTheTerrainIsMade) {
  const std::string large = "base = \"vicksburg\"\n[scene]\nextent_m = 3000.0\nterrain_cell_m = 0.5\n";
  const double before_s = canyon::testing::process_cpu_s();
  EXPECT_THAT(message(large + "[[autonomy.waypoint]]\nname = \"far\"\np_m = [5000.0, 0.0]\n"),
              HasSubstr("my.toml:5: autonomy.waypoint[1]: waypoint \"far\" at (5000.0, 0.0) lies outside the scene, "
                        "expected x from -1500 to 1500, y from -1500 to 1500 (scene.extent_m)"));
  EXPECT_THAT(message(large + "[[scene.moving]]\npath_m = [0.0, 5000.0]\n[vehicle]\nstart_m = [0, 5000]\n"),
              HasSubstr("vehicle.start_m: (0.0, 5000.0) lies outside the scene"));
  EXPECT_LT(canyon::testing::process_cpu_s() - before_s, 2.0);
}

TEST(MissionFileMessages, UnknownBuilding) {
  EXPECT_THAT(
      message("base = \"vicksburg\"\n[[autonomy.waypoint]]\nname = \"x\"\np_m = [213.9, 100.0]\nobserve = "
              "\"buildin 247\"\n"),
      HasSubstr("my.toml:2: autonomy.waypoint[1]: waypoint \"x\": no building named \"buildin 247\", expected a "
                "building of the scene; nearest is \"building 247\""));
  // 2026-11-30: nearest is "".
  EXPECT_EQ(message("base = \"vicksburg\"\n[[autonomy.waypoint]]\nname = \"x\"\np_m = [213.9, 100.0]\nobserve = \"tree "
                    "1\"\n"),
            "my.toml:2: autonomy.waypoint[1]: waypoint \"x\": no building named \"tree 1\", expected a building of the "
            "scene");
}

TEST(MissionFileMessages, AnInheritedWaypointInAnotherCity) {
  EXPECT_THAT(message("base = \"vicksburg\"\n\n[scene]\nseed = 5\n"),
              ::testing::MatchesRegex("my.toml:3: autonomy.waypoint.[0-9]+.: waypoint \"[0-9]+\".* .inherited from "
                                      "missions/vicksburg.toml; this .scene. is another city., expected .*"));
}

// 2026-11-23: expected x from inf to -inf.
TEST(MissionFileMessages, ASceneOfWhichNothingIsLeft) {
  const canyon::testing::TemporaryFolder folder;
  const std::string path = folder.file("wall.obj");
  ASSERT_TRUE(write_text_file(path, "v 50 0 0\nv 60 0 0\nv 60 0 9\nf 1 2 3\n").ok());
  const std::string scene = "[scene]\nfile = \"" + path + "\"\n",
                    rest = "[[autonomy.waypoint]]\nname = \"a\"\np_m = [900, 0]\n";
  EXPECT_THAT(message(scene + "radius_m = 1.0\n" + rest),
              HasSubstr(": vehicle.start_m: the scene is empty, expected something to stand on (scene.margin_m, "
                        "scene.radius_m)"));
  EXPECT_THAT(message(scene + "radius_m = 100.0\n" + rest), HasSubstr(" (scene.margin_m, scene.radius_m)"));
  EXPECT_THAT(message(scene + rest), HasSubstr("lies outside the scene, expected x from "));
}

// 2026-11-23: no word of the option.
TEST(MissionFileMessages, AnInheritedWaypointInACityThatAnOptionChanges) {
  MissionFile file = parse("base = \"vicksburg\"\n");
  file.set_option("scene.seed", ConfigNode::of(std::int64_t{5}), "--set");
  SceneCache scenes;
  const auto mission = prepare(*file.resolve("high"), scenes);
  ASSERT_FALSE(mission.ok());
  EXPECT_THAT(
      file.locate(mission.error(), "high").str(),
      ::testing::MatchesRegex("missions/vicksburg.toml:[0-9]+: autonomy.waypoint.[0-9]+.: waypoint \"[0-9]+\".* "
                              ".inherited from missions/vicksburg.toml; scene.seed makes it another city., "
                              "expected .*"));
}

// 2026-11-25: with any other key of [autonomy] set, the waypoint was told as an option's, with no word of the city.
TEST(MissionFileMessages, AnInheritedWaypointBesideAnotherKeyOfItsSection) {
  MissionFile file = parse("base = \"vicksburg\"\n");
  file.set_option("scene.seed", ConfigNode::of(std::int64_t{5}), "--set");
  file.set_option("autonomy.perception.cell_m", ConfigNode::of(0.1), "--set");
  SceneCache scenes;
  const auto mission = prepare(*file.resolve("high"), scenes);
  ASSERT_FALSE(mission.ok());
  EXPECT_THAT(file.locate(mission.error(), "high").str(),
              ::testing::MatchesRegex("missions/vicksburg.toml:[0-9]+: autonomy.waypoint.[0-9]+.: .*"
                                      "; scene.seed makes it another city., expected .*"));
}

}  // namespace
}  // namespace canyon::mission
