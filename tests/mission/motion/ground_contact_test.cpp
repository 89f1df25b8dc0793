// How the wheels hold a body without springs.
#include "canyon/mission/motion/ground_contact.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/surfaces/material.h"

namespace canyon::mission {
namespace {

constexpr double kEast = 1.0 / 16.0, kNorth = 1.0 / 32.0;  // rise of the plane; its corners are exact in a mesh

/// 50 m to each side of W's origin.
scene::Scene tilted_plane() {
  scene::SceneParts parts;
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  const auto corner = [](double x, double y) { return Eigen::Vector3d(x, y, kEast * x + kNorth * y); };
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad(corner(-50, -50), corner(50, -50), corner(50, 50), corner(-50, 50), mesh.material("asphalt"));
  return scene::Scene(std::move(parts));
}

// On a plane the body lies in it: its axes rise by atan of the slope along each. Some ten operations on numbers up to
// 50 m round by 1e-13 m, of which an angle takes a wheelbase's or a track's share.
TEST(GroundContact, OnAPlaneItIsThePlanes) {
  const scene::Scene scene = tilted_plane();
  const VehicleConfig vehicle;
  for (const double yaw_deg : {0.0, 35.0, 90.0, 200.0}) {
    const double c = std::cos(yaw_deg * kDegree), s = std::sin(yaw_deg * kDegree);
    const auto contact = ground_contact(vehicle, scene, nullptr, {3.0, 4.0}, yaw_deg * kDegree);
    ASSERT_TRUE(contact.has_value());
    EXPECT_NEAR(contact->heave_m, 3.0 * kEast + 4.0 * kNorth, 1e-13) << yaw_deg;
    EXPECT_NEAR(contact->pitch_rad, -std::atan(c * kEast + s * kNorth), 1e-13) << yaw_deg;
    EXPECT_NEAR(contact->roll_rad, std::atan(c * kNorth - s * kEast), 1e-13) << yaw_deg;
  }
}

// Each wheel stands on the road's own height there.
TEST(GroundContact, RoughnessLiesOnTheTerrain) {
  const scene::Scene scene = tilted_plane();
  const VehicleConfig vehicle;
  const RoadRoughness roughness("E", 7);
  const auto rough = ground_contact(vehicle, scene, &roughness, {3.0, 4.0}, 0.0);
  ASSERT_TRUE(rough.has_value());
  const double L_m = vehicle.wheelbase_m, w_m = vehicle.track_m;
  const auto road_m = [&roughness](double x, double y) {
    return kEast * x + kNorth * y + roughness.height_m(Eigen::Vector2d(x, y));
  };
  const double rear_left_m = road_m(3.0, 4.0 + 0.5 * w_m), rear_right_m = road_m(3.0, 4.0 - 0.5 * w_m);
  const double front_left_m = road_m(3.0 + L_m, 4.0 + 0.5 * w_m), front_right_m = road_m(3.0 + L_m, 4.0 - 0.5 * w_m);
  EXPECT_NEAR(rough->heave_m, 0.5 * (rear_left_m + rear_right_m), 1e-13);
  EXPECT_NEAR(std::tan(rough->pitch_rad) * L_m,
              0.5 * (rear_left_m + rear_right_m) - 0.5 * (front_left_m + front_right_m), 1e-12);
  EXPECT_NEAR(std::tan(rough->roll_rad) * w_m,
              0.5 * (rear_left_m + front_left_m) - 0.5 * (rear_right_m + front_right_m), 1e-12);
  EXPECT_NE(rear_left_m, rear_right_m + kNorth * w_m);
}

TEST(GroundContact, NoneWithAWheelOffTheTerrain) {
  const scene::Scene scene = tilted_plane();
  const VehicleConfig vehicle;  // its front axle is 1.8 m ahead, its wheels 0.65 m aside
  EXPECT_TRUE(ground_contact(vehicle, scene, nullptr, {48.1, 0.0}, 0.0).has_value());
  EXPECT_FALSE(ground_contact(vehicle, scene, nullptr, {48.3, 0.0}, 0.0).has_value());
  EXPECT_FALSE(ground_contact(vehicle, scene, nullptr, {0.0, 49.5}, 0.0).has_value());
}

}  // namespace
}  // namespace canyon::mission
