// What of the body is held against the scene.
#include "canyon/mission/collision/collision.h"

#include <gtest/gtest.h>

#include "canyon/core/truth.h"
#include "canyon/mission/motion/vehicle_config.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene_at.h"
#include "canyon/scene/surfaces/material.h"

namespace canyon::mission {
namespace {

struct Yard {
  scene::SceneParts parts;
  scene::MeshBuilder mesh{parts};
  std::uint16_t metal = 0;
  Yard() {
    parts.materials = scene::builtin_materials();
    metal = mesh.material("painted_metal");
    mesh.begin_object("ground", scene::ObjectKind::kTerrain);
    mesh.quad({-30, -30, 0}, {30, -30, 0}, {30, 30, 0}, {-30, 30, 0}, metal);
  }
  void box(const std::string& name, const Eigen::Vector3d& middle, const Eigen::Vector3d& half) {
    mesh.begin_object(name, scene::ObjectKind::kOther);
    mesh.box(middle, Eigen::Matrix3d::Identity(), half, metal);
  }
};

/// Along x at 5 cm a step, from x = -10 m; where the rear axle was when something was touched, and what.
std::pair<double, std::string> drive_into(const char* model, const scene::SceneAt& at) {
  ModelParameters own;
  const auto check = model_row(collision_checks(), model).make(own, VehicleConfig{}, at);
  for (double x = -10.0; x < 10.0; x += 0.05) {
    KinematicState state;
    state.X_WB.p = {x, 0.0, 0.0};
    if (const auto object = check->touched(state)) return {x, at.object(*object).name};
  }
  return {1e9, ""};
}

// The front is 2.2 m ahead of the rear axle. A post of 5 cm beside the lines, a kerb stone lower than them and a beam
// above them are the box's alone; what is lower than the clearance or higher than the body is nobody's.
TEST(Collisions, TheBoxMeetsWhatLiesBetweenTheLines) {
  struct Case {
    const char* what;
    Eigen::Vector3d middle, half;
    bool lines, box;
  };
  const Case cases[] = {
      {"car", {3.0, 0.0, 0.7}, {1.0, 0.8, 0.7}, true, true},
      {"stone", {2.025, 0.0, 0.2}, {0.025, 0.5, 0.2}, false, true},
      {"beam", {2.025, 0.0, 1.5}, {0.025, 3.0, 0.05}, false, true},
      {"cable", {2.025, 0.0, 0.075}, {0.025, 3.0, 0.075}, false, false},
      {"bridge", {2.025, 0.0, 1.9}, {0.025, 3.0, 0.2}, false, false},
      {"wall beside", {0.0, 0.8, 1.0}, {9.0, 0.04, 1.0}, false, false},
  };
  for (const Case& c : cases) {
    Yard yard;
    yard.box(c.what, c.middle, c.half);
    const scene::Scene scene(std::move(yard.parts));
    const scene::SceneAt at(scene);
    for (const auto& [model, meets] : {std::pair{"lines", c.lines}, {"box", c.box}}) {
      const auto [x, name] = drive_into(model, at);
      EXPECT_EQ(name, meets ? c.what : "") << model;
      if (!meets) continue;
      const double touches_m = c.middle.x() - c.half.x() - 2.2;
      EXPECT_GE(x, touches_m) << model << " " << c.what;
      EXPECT_LE(x, touches_m + (std::string(model) == "box" ? 0.05 : 0.1) + 1e-9) << model << " " << c.what;
    }
  }
}

// A thing that comes to the vehicle while it stands.
TEST(Collisions, TheBoxIsHitWhileItStands) {
  Yard yard;
  const scene::Scene scene(std::move(yard.parts));
  scene::SceneParts parts;
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("cart", scene::ObjectKind::kVehicle);
  mesh.box({0, 0, 0.5}, Eigen::Matrix3d::Identity(), {0.5, 0.5, 0.5}, 0);
  const auto shape = std::make_shared<const scene::RigidShape>("cart", scene::ObjectKind::kVehicle, parts.mesh);
  scene::SceneAt at(scene);
  ModelParameters own;
  const auto box = model_row(collision_checks(), "box").make(own, VehicleConfig{}, at);
  const auto lines = model_row(collision_checks(), "lines").make(own, VehicleConfig{}, at);
  const KinematicState standing;
  lines->touched(standing);
  double hit_at = 0.0;
  for (double y = 4.0; y > 1.0; y -= 0.01) {
    at.set_instances({{shape, "cart", {Eigen::Quaterniond::Identity(), {1.0, y, 0.0}}}});
    if (const auto object = box->touched(standing); object && hit_at == 0.0) {
      hit_at = y;
      EXPECT_EQ(at.object(*object).name, "cart");
    }
    EXPECT_FALSE(lines->touched(standing)) << "lines look after some way only";
  }
  EXPECT_NEAR(hit_at, 0.75 + 0.5, 0.011);
}

}  // namespace
}  // namespace canyon::mission
