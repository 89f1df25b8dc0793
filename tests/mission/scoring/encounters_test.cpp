#include "canyon/mission/scoring/encounters.h"

#include <cmath>
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "canyon/lidar/beam/no_surface.h"
#include "canyon/mission/scoring/sightings.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/surfaces/material.h"

namespace canyon::mission {
namespace {

/// A lane along x with a post of 20 cm at x = 20 m, so far beside the axis, and maybe a second one elsewhere.
struct Lane {
  static constexpr std::uint32_t kGround = 0, kPost = 1, kSecond = 2;  // objects

  explicit Lane(double post_y_m, std::optional<Eigen::Vector2d> second = std::nullopt) {
    scene::SceneParts parts;
    parts.materials = scene::builtin_materials();
    scene::MeshBuilder mesh(parts);
    mesh.begin_object("ground", scene::ObjectKind::kTerrain);
    mesh.quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}, 0);
    mesh.begin_object("post", scene::ObjectKind::kPole);
    mesh.box({20, post_y_m, 1}, Eigen::Matrix3d::Identity(), {0.1, 0.1, 1}, 0);
    if (second) {
      mesh.begin_object("second post", scene::ObjectKind::kPole);
      mesh.box({second->x(), second->y(), 1}, Eigen::Matrix3d::Identity(), {0.1, 0.1, 1}, 0);
    }
    scene = std::make_unique<scene::Scene>(std::move(parts));
    at = std::make_unique<scene::SceneAt>(*scene);
  }
  std::unique_ptr<scene::Scene> scene;
  std::unique_ptr<scene::SceneAt> at;
};

KinematicState state_at(double x_m, double t_s) {
  KinematicState state;
  state.t = GpsTime{static_cast<std::int64_t>(t_s * 1e9)};
  state.X_WB.p = {x_m, 0.0, 0.0};
  return state;
}

/// Along the lane at 5 m/s to x = `to_m` while `command` is asked for.
Encounters::Numbers drive(const Lane& lane, double to_m, const DriveCommand& command, AutonomyState state) {
  Encounters encounters(SuccessConfig{}, VehicleConfig{}, *lane.at);
  for (double t_s = 0.0; 5.0 * t_s < to_m; t_s += 0.01) encounters.look(state_at(5.0 * t_s, t_s), 5.0, command, state);
  return encounters.numbers();
}

// Half of the body is 0.75 m wide: a post with its face at 0.9 m is passed at 0.15 m.
TEST(Encounters, ANearMissIsCountedOnceAndTheClearanceIsTheSurfaces) {
  const auto near = drive(Lane(1.0), 30.0, {5.0, 0.0}, AutonomyState::kDriving);
  EXPECT_NEAR(near.clearance_min_m, 0.15, 1e-6);
  EXPECT_EQ(near.near_misses, 1);
  EXPECT_EQ(near.missed_obstacles, 0) << "it lies beside the way";
  const auto far = drive(Lane(2.0), 30.0, {5.0, 0.0}, AutonomyState::kDriving);
  EXPECT_NEAR(far.clearance_min_m, 1.15, 1e-6);
  EXPECT_EQ(far.near_misses, 0);
  EXPECT_EQ(drive(Lane(9.0), 30.0, {5.0, 0.0}, AutonomyState::kDriving).clearance_min_m, Encounters::kFar_m);
}

/// Along the lane at 5 m/s until x = `to_m`, where an object is touched.
Encounters::Numbers run_into(const Lane& lane, double to_m, std::uint32_t object) {
  Encounters encounters(SuccessConfig{}, VehicleConfig{}, *lane.at);
  double t_s = 0.0;
  for (; 5.0 * t_s < to_m; t_s += 0.01)
    encounters.look(state_at(5.0 * t_s, t_s), 5.0, {5.0, 0.0}, AutonomyState::kDriving);
  encounters.touched(object, state_at(to_m, t_s).t);
  return encounters.numbers();
}

// 2026-11-30: who drove into a thing had a near miss, and the least distance was what was left of the 0.2 m between two
// looks. The body's front is 2.2 m ahead of the rear axle, so the post is met at 17.7 m.
TEST(Encounters, WhatIsTouchedIsNoNearMissAndNoDistanceIsLeft) {
  const double met_m = 17.7;
  const auto before = drive(Lane(0.0), met_m - 0.05, {5.0, 0.0}, AutonomyState::kDriving);
  EXPECT_EQ(before.near_misses, 1);
  EXPECT_GT(before.clearance_min_m, 0.0);
  const auto hit = run_into(Lane(0.0), met_m - 0.05, Lane::kPost);
  EXPECT_EQ(hit.near_misses, 0);
  EXPECT_EQ(hit.clearance_min_m, 0.0);
  // However far off it was at the last look.
  EXPECT_EQ(run_into(Lane(9.0), 10.0, Lane::kPost).clearance_min_m, 0.0);
  EXPECT_EQ(run_into(Lane(9.0), 10.0, Lane::kPost).near_misses, 0);
  // The ground is no thing.
  const auto grounded = run_into(Lane(1.0), 30.0, Lane::kGround);
  EXPECT_NEAR(grounded.clearance_min_m, 0.15, 1e-6);
  EXPECT_EQ(grounded.near_misses, 1);
}

// Another post is passed at 0.15 m: more than a second, 5 m, before the one that is hit; and just before it.
TEST(Encounters, WhatWasPassedBeforeStaysANearMiss) {
  for (const double before_m : {12.0, 1.0}) {
    const auto passed = run_into(Lane(0.0, Eigen::Vector2d(20.0 - before_m, 1.0)), 17.65, Lane::kPost);
    EXPECT_EQ(passed.near_misses, 1) << before_m;
    EXPECT_EQ(passed.clearance_min_m, 0.0) << before_m;
  }
  // The same thing, passed well before it is touched: the first time was a near miss, the second is none.
  const Lane lane(1.0);
  Encounters encounters(SuccessConfig{}, VehicleConfig{}, *lane.at);
  double t_s = 0.0;
  for (; 5.0 * t_s < 40.0; t_s += 0.01)
    encounters.look(state_at(5.0 * t_s, t_s), 5.0, {5.0, 0.0}, AutonomyState::kDriving);
  encounters.look(state_at(20.0, t_s), 5.0, {5.0, 0.0}, AutonomyState::kDriving);
  EXPECT_EQ(encounters.numbers().near_misses, 2);
  encounters.touched(Lane::kPost, state_at(20.0, t_s + 0.01).t);
  EXPECT_EQ(encounters.numbers().near_misses, 1);
}

// What a look itself finds touched, as a low wall that the collision check by lines passes over.
TEST(Encounters, WhatALookFindsTouchedIsNoNearMiss) {
  const auto through = drive(Lane(0.0), 30.0, {5.0, 0.0}, AutonomyState::kDriving);
  EXPECT_EQ(through.clearance_min_m, 0.0);
  EXPECT_EQ(through.near_misses, 0);
}

/// A slab beside the way, from half a metre off, as a pavement or a low wall.
double clearance_beside_m(double height_m, scene::ObjectKind kind) {
  scene::SceneParts parts;
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}, 0);
  mesh.begin_object("slab", kind);
  mesh.box({20, 2.25, 0.5 * height_m}, Eigen::Matrix3d::Identity(), {10.0, 1.0, 0.5 * height_m}, 0);
  const scene::Scene scene(std::move(parts));
  const scene::SceneAt at(scene);
  Encounters encounters(SuccessConfig{}, VehicleConfig{}, at);
  for (double x_m = 0.0; x_m < 30.0; x_m += 0.05)
    encounters.look(state_at(x_m, x_m / 5.0), 5.0, {5.0, 0.0}, AutonomyState::kDriving);
  return encounters.numbers().clearance_min_m;
}

// The body begins 0.2 m above the ground: it passes over what is lower, and keeps clear of what is not. A part of a car
// counts whatever its height.
TEST(Encounters, WhatIsLowerThanTheBodyIsNoThing) {
  EXPECT_EQ(clearance_beside_m(0.15, scene::ObjectKind::kOther), Encounters::kFar_m);
  EXPECT_NEAR(clearance_beside_m(0.5, scene::ObjectKind::kOther), 0.5, 1e-6);
  EXPECT_NEAR(clearance_beside_m(0.15, scene::ObjectKind::kVehicle), std::hypot(0.5, 0.05), 1e-6);
}

// From 5 m/s it stops within 4.2 m: who asks for no less speed nearer than that has missed the post.
TEST(Encounters, WhoDoesNotSlowDownBeforeAThingHasMissedIt) {
  const double front_m = 2.2, face_m = 19.9;
  const double just_m = face_m - front_m - 25.0 / 6.0;
  EXPECT_EQ(drive(Lane(0.0), just_m - 0.6, {5.0, 0.0}, AutonomyState::kDriving).missed_obstacles, 0);
  EXPECT_EQ(drive(Lane(0.0), just_m + 1.2, {5.0, 0.0}, AutonomyState::kDriving).missed_obstacles, 1);
  EXPECT_EQ(drive(Lane(0.0), just_m + 1.2, {0.0, 0.0}, AutonomyState::kDriving).missed_obstacles, 0) << "it brakes";
}

// It says that it finds no way: before a post it is right, before nothing it is not.
TEST(Encounters, NoWayWithAFreeLaneIsAPhantom) {
  EXPECT_EQ(drive(Lane(9.0), 10.0, {0.0, 0.0}, AutonomyState::kBlocked).phantoms, 1);
  EXPECT_EQ(drive(Lane(9.0), 10.0, {0.0, 0.0}, AutonomyState::kObserving).phantoms, 0);
  const Lane blocked(0.0);
  Encounters encounters(SuccessConfig{}, VehicleConfig{}, *blocked.at);
  for (double t_s = 0.0; t_s < 5.0; t_s += 0.01)
    encounters.look(state_at(15.0, t_s), 0.0, {0.0, 0.0}, AutonomyState::kBlocked);
  EXPECT_EQ(encounters.numbers().phantoms, 0);
}

TEST(Sightings, TellWhatTheLastScanShowedAndSinceWhen) {
  Sightings sightings;
  const auto scan = [&](double t_s, std::vector<std::pair<std::uint32_t, float>> returns) {
    std::vector<LidarPointTruth> truth;
    for (const auto& [object, range] : returns) truth.push_back({range, 1.0f, 0, object});
    sightings.scan(GpsTime{static_cast<std::int64_t>(t_s * 1e9)}, truth);
  };
  scan(1.0, {{7, 12.0f}, {7, 11.5f}, {3, 2.0f}});
  scan(1.1, {{7, 11.0f}});
  scan(1.8, {{7, 8.0f}});  // a gap of 0.7 s: seen anew
  scan(1.9, {{7, 7.5f}, {7, 7.7f}});
  scan(2.0, {{3, 1.0f}});
  const auto seen = sightings.of(7, GpsTime{2'050'000'000});
  ASSERT_TRUE(seen.has_value());
  EXPECT_FLOAT_EQ(seen->range_m, 7.5f);
  EXPECT_NEAR(seen->stood_s, 0.1, 1e-9);
  EXPECT_NEAR(seen->ago_s, 0.15, 1e-9);
  EXPECT_FALSE(sightings.of(8, GpsTime{2'050'000'000}));
}

// 2026-11-25: a return that no surface sent (fog) was looked up by its object, and a mission ended with signal 11.
TEST(Sightings, LeaveOutWhatNoSurfaceSent) {
  Sightings sightings;
  sightings.scan(GpsTime{0}, {{3.0f, 1.0f, lidar::kNoMaterial, lidar::kNoObject}, {12.0f, 1.0f, 0, 7}});
  EXPECT_TRUE(sightings.of(7, GpsTime{0}));
  EXPECT_FALSE(sightings.of(lidar::kNoObject, GpsTime{0}));
}

}  // namespace
}  // namespace canyon::mission
