// What an autonomy holds against what stands, and what it asks for against another, counted by hand.
#include "canyon/study/reproduce/detections.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/mission/route_tape.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/surfaces/material.h"
#include "canyon/study/reproduce/detection.h"
#include "canyon/tests/mission/short_mission.h"

namespace canyon::study {
namespace {

// A wall across the way, 10 m ahead, whose ends are seen 16.5 degrees to both sides: 17 of the 41 directions meet it,
// and the next are 0.27 m beside its end, over the 0.2 m within which a cell would lie in them.
constexpr double kWall_m = 10.0, kEnd_deg = 16.5;
constexpr int kOnWall = 17;

double half_width_m() {
  return kWall_m * std::tan(kEnd_deg * kDegree);
}

/// Level ground, and the wall 3 m high and 0.2 m thick.
scene::Scene scene_of_wall() {
  scene::SceneParts parts;
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  const std::uint16_t concrete = mesh.material("concrete");
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}, concrete);
  mesh.begin_object("wall", scene::ObjectKind::kWall);
  mesh.block(scene::rectangle(kWall_m, -half_width_m(), kWall_m + 0.2, half_width_m()), 0, 3, concrete, concrete);
  return scene::Scene(std::move(parts));
}

/// Its near face as cells whose middles are at most 0.05 m apart.
std::vector<Eigen::Vector2d> cells_of_wall() {
  std::vector<Eigen::Vector2d> cells;
  constexpr int kCells = 200;
  for (int i = 0; i <= kCells; ++i) cells.emplace_back(kWall_m, half_width_m() * (2.0 * i / kCells - 1.0));
  return cells;
}

Detections seen_from(const Eigen::Vector2d& believed, double yaw_rad = 0.0) {
  const scene::Scene scene = scene_of_wall();
  Detections found;
  found.add(held_ranges(cells_of_wall(), believed, yaw_rad), true_ranges(scene::SceneAt(scene), {}));
  return found;
}

TEST(Detections, TrueRangesAreThoseOfAWall) {
  const scene::Scene scene = scene_of_wall();
  const Ranges truly = true_ranges(scene::SceneAt(scene), {});
  ASSERT_EQ(truly.size(), 41U);
  for (int k = 0; k < kDirections; ++k) {
    const double degrees = 2.0 * k - 40.0;
    const double expected_m = std::abs(degrees) < kEnd_deg ? kWall_m / std::cos(degrees * kDegree) : kReach_m;
    // n eps scale: directions and ranges are single precision, 20 m at most.
    EXPECT_NEAR(truly[static_cast<std::size_t>(k)], expected_m, 8 * 6e-8 * 20.0) << degrees;
  }
}

TEST(Detections, WithTheTruePoseNothingIsPhantomOrMissed) {
  const Detections found = seen_from({0.0, 0.0});
  EXPECT_EQ(found.phantom_share(), 0.0);
  EXPECT_EQ(found.missed_share(), 0.0);
  // The nearest cell of a direction may lie 0.2 m beside it, and is then nearer by 0.2 tan(16 degrees) at most.
  EXPECT_LT(found.range_rms_m(), 0.2 * std::tan(16.0 * kDegree));
}

// Taken to be 2 m farther on, the vehicle has all of the wall 2 m nearer than it stands, and where the wall reaches
// farther round, it is where nothing stands: its end, 2.96 m aside, is then seen 20.3 degrees off, so that 18 and 20
// degrees on both sides meet it too.
TEST(Detections, APoseTooFarOnMakesPhantoms) {
  const Detections found = seen_from({2.0, 0.0});
  EXPECT_EQ(found.phantom_share(), (kOnWall + 4) / 41.0);
  EXPECT_EQ(found.missed_share(), 0.0);
}

// Taken to be 2 m farther back, it has all of the wall farther off than it stands, or not at all.
TEST(Detections, APoseTooFarBackMisses) {
  const Detections found = seen_from({-2.0, 0.0});
  EXPECT_EQ(found.phantom_share(), 0.0);
  EXPECT_EQ(found.missed_share(), 1.0);
}

// Taken to be so far to the left that the wall's right end is seen 30.5 degrees to the right, and its left end just
// left of straight ahead. Held are 0 to 30 degrees to the right, 16 directions. 18 to 30 degrees, 7, are free in truth;
// of the 17 in which the wall truly stands, the 8 to the left are held to be free.
TEST(Detections, APoseBesideTheTrueOneMakesPhantomsOnOneSideAndMissesOnTheOther) {
  const double aside_m = kWall_m * std::tan(30.5 * kDegree) - half_width_m();
  const Detections found = seen_from({0.0, aside_m});
  EXPECT_EQ(found.phantom_share(), 7.0 / 41.0);
  EXPECT_EQ(found.missed_share(), 8.0 / kOnWall);
}

// Turned to the left by two directions, what it holds lies two directions farther to the right.
TEST(Detections, AHeadingThatIsOffShiftsByDirections) {
  const Detections found = seen_from({0.0, 0.0}, 4.0 * kDegree);
  EXPECT_EQ(found.phantom_share(), 2.0 / 41.0);
  EXPECT_EQ(found.missed_share(), 2.0 / kOnWall);
}

TEST(Detections, RangesAreComparedWhereThereIsSomethingInBoth) {
  Detections found;
  EXPECT_TRUE(std::isnan(found.phantom_share()));
  EXPECT_TRUE(std::isnan(found.missed_share()));
  found.add({10.5, kReach_m, 8.0, kReach_m}, {10.0, 12.0, kReach_m, kReach_m});
  EXPECT_EQ(found.phantom_share(), 1.0 / 4.0);
  EXPECT_EQ(found.missed_share(), 1.0 / 2.0);
  EXPECT_EQ(found.range_rms_m(), 0.5);
}

// Two of four rows steer by 6 degrees more: 6 / sqrt(2). The last row has nothing to be held against.
TEST(CommandDifference, IsTheRootMeanSquareOfAnglesAndSpeeds) {
  constexpr double kWheelbase_m = 2.7;
  const auto command = [](double speed_m_s, double angle_deg) {
    return DriveCommand{speed_m_s, std::tan(angle_deg * kDegree) / kWheelbase_m};
  };
  const std::vector<DriveCommand> a{command(3, 10), command(3, -5), command(3, 4), command(3, 0), command(9, 9)};
  const std::vector<DriveCommand> b{command(3, 4), command(3, -5), command(3, -2), command(1, 0)};
  const CommandDifference difference = command_difference(a, b, kWheelbase_m);
  constexpr double kRounding = 100 * 2.2e-16;  // n eps scale: tangents there and back, of tens of degrees
  EXPECT_NEAR(difference.steering_rms_deg, 6.0 / std::sqrt(2.0), 10.0 * kRounding);
  EXPECT_EQ(difference.speed_rms_m_s, 1.0);
  EXPECT_EQ(command_difference(a, a, kWheelbase_m).steering_rms_deg, 0.0);
  EXPECT_TRUE(std::isnan(command_difference(a, {}, kWheelbase_m).steering_rms_deg));
}

// The whole of it on a drive, by sensors without errors. Whoever follows the route steers by 2 (e + d h) / d^2 of a
// place e and a heading h that are off, d at least 2.5 m ahead: with 5 mm and 0.001 rad, more than such an estimate
// errs by, and 1.8 m of wheelbase that is 0.25 degrees.
TEST(SeenAndPlanned, WithoutErrorsNearlyTheSameIsAskedForAsWithTheTruePose) {
  const auto config = mission::testing::short_config(
      "low", "low",
      "[time]\nlimit_s = 5.0\n[lidar]\nazimuth_steps = 600\n[autonomy]\nmodel = \"route_follower\"\n"
      "[gnss]\nmodel = \"truth_plus_white\"\nwhite_sigma_m = 0.0\nwhite_sigma_up_m = 0.0\n"
      "[imu]\nerrors = \"none\"\n[run]\ninitial_attitude_error_deg = [0.0, 0.0, 0.0]\n");
  ASSERT_EQ(config.vehicle.wheelbase_m, 1.8);
  const auto mission = mission::prepare(config, mission::testing::scenes());
  ASSERT_TRUE(mission.ok()) << mission.error().str();
  const auto tape = mission::drive_route(config, *mission);
  ASSERT_TRUE(tape.ok()) << tape.error().str();
  const auto found = seen_and_planned(config, *mission, *tape);
  ASSERT_TRUE(found.ok()) << found.error().str();
  EXPECT_LT(found->steering_rms_deg, 0.25);
  EXPECT_GE(found->phantom_share, 0.0) << "scans must have been looked at";
}

}  // namespace
}  // namespace canyon::study
