// How much a search for a way to a waypoint takes, and what it says where it cannot tell.
#include "canyon/mission/config/waypoint_reach.h"

#include <vector>

#include <gtest/gtest.h>

#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/surfaces/material.h"

namespace canyon::mission {
namespace {

struct StandingBox {
  Eigen::Vector3d middle, half;
};

/// Level ground, 150 m to each side of W's origin, and what stands on it.
scene::Scene ground_with(const std::vector<StandingBox>& boxes) {
  scene::SceneParts parts;
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  const std::uint16_t concrete = mesh.material("concrete");
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-150, -150, 0}, {150, -150, 0}, {150, 150, 0}, {-150, 150, 0}, concrete);
  for (const StandingBox& box : boxes) {
    mesh.begin_object("box", scene::ObjectKind::kWall);
    mesh.box(box.middle, Eigen::Matrix3d::Identity(), box.half, concrete);
  }
  return scene::Scene(std::move(parts));
}

/// Four walls, 3 m high, whose inner sides are so far from W's origin.
std::vector<StandingBox> walls_around(double inner_m) {
  const double middle_m = inner_m + 0.5;
  return {{{middle_m, 0.0, 1.5}, {0.5, middle_m + 0.5, 1.5}},
          {{-middle_m, 0.0, 1.5}, {0.5, middle_m + 0.5, 1.5}},
          {{0.0, middle_m, 1.5}, {middle_m + 0.5, 0.5, 1.5}},
          {{0.0, -middle_m, 1.5}, {middle_m + 0.5, 0.5, 1.5}}};
}

/// A body that starts farther from W's origin than is looked at.
VehicleConfig far_away(double length_m, double width_m) {
  VehicleConfig vehicle;
  vehicle.length_m = length_m;
  vehicle.width_m = width_m;
  vehicle.start_m = {-140.0, 0.0};
  return vehicle;
}

const Eigen::Vector2d kPlace = Eigen::Vector2d::Zero();

// The radius is the widest that there is. Straight in, 15 m are 101 places 0.15 m apart, each looked at by 48 headings
// at most; the sides of the square alone, which were all looked at until 2026-11-30, are more.
TEST(WaypointReach, AWayStraightInTakesNoMoreForAWideRadius) {
  const scene::Scene scene = ground_with({{{0.0, 0.0, 1.0}, {2.0, 2.0, 1.0}}});
  const scene::SceneAt at(scene);
  const WaypointReach reach(far_away(2.6, 1.5), 100.0, at);
  const WaypointReach::Way way = reach.way_to(kPlace);
  EXPECT_TRUE(way.may_be);
  EXPECT_GT(way.checks, 0);
  EXPECT_LE(way.checks, 101 * 48);
}

// All of the square around the walls is looked at before it is known that none leads in.
TEST(WaypointReach, WhatIsNotSettledMayBe) {
  const scene::Scene scene = ground_with(walls_around(8.0));
  const scene::SceneAt at(scene);
  const VehicleConfig vehicle = far_away(6.0, 3.0);
  const WaypointReach::Way settled = WaypointReach(vehicle, 2.0, at).way_to(kPlace);
  EXPECT_FALSE(settled.may_be);
  EXPECT_LT(settled.checks, WaypointReach::kMostChecks);
  constexpr std::int64_t kFew = 500;
  const WaypointReach::Way cut_short = WaypointReach(vehicle, 2.0, at, kFew).way_to(kPlace);
  EXPECT_TRUE(cut_short.may_be);
  EXPECT_GE(cut_short.checks, kFew);
  EXPECT_LT(cut_short.checks, kFew + 48) << "the place that is being looked at is looked at to the end";
}

// Smaller by what lies between headings, a body twelve times as long as it is wide would have hardly any width left.
TEST(WaypointReach, OfALongThinBodyNothingIsSaid) {
  const scene::Scene scene = ground_with(walls_around(8.0));
  const scene::SceneAt at(scene);
  const WaypointReach::Way way = WaypointReach(far_away(12.0, 1.0), 2.0, at).way_to(kPlace);
  EXPECT_TRUE(way.may_be);
  EXPECT_EQ(way.checks, 0);
}

}  // namespace
}  // namespace canyon::mission
