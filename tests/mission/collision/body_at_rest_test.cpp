#include "canyon/mission/collision/body_at_rest.h"

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/mission/motion/vehicle.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/surfaces/material.h"

namespace canyon::mission {
namespace {

/// 50 m to each side, rising to the north-east, with a fold along the diagonal.
scene::Scene folded_ground() {
  scene::SceneParts parts;
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-50, -50, 0}, {50, -50, 3}, {50, 50, 12}, {-50, 50, 1}, mesh.material("asphalt"));
  return scene::Scene(std::move(parts));
}

// The wheels stand on both sides of the fold. A hundred operations on metres: 100 eps 10 m.
TEST(BodyAtRest, StandsAsTheVehicleDoesAtItsStart) {
  const scene::Scene scene = folded_ground();
  for (const double heading_deg : {0.0, 40.0, 130.0, 275.0}) {
    VehicleConfig config;
    config.roughness = "none";
    config.start_m = {3.0, 3.4};
    config.start_heading_deg = heading_deg;
    const Pose vehicle = Vehicle(config, scene, 1, GpsTime{}).state().X_WB;
    const auto body = body_at_rest(config, scene, config.start_m, yaw_from_heading(heading_deg * kDegree));
    ASSERT_TRUE(body.has_value());
    EXPECT_LT((body->p - vehicle.p).norm(), 1e-12) << heading_deg;
    EXPECT_LT(body->R.angularDistance(vehicle.R), 1e-12) << heading_deg;
  }
}

TEST(BodyAtRest, StandsNowhereWithAWheelOffTheTerrain) {
  const scene::Scene scene = folded_ground();
  const VehicleConfig config;  // its front axle is 1.8 m ahead
  EXPECT_TRUE(body_at_rest(config, scene, {48.1, 0.0}, 0.0).has_value());
  EXPECT_FALSE(body_at_rest(config, scene, {48.3, 0.0}, 0.0).has_value());
}

}  // namespace
}  // namespace canyon::mission
