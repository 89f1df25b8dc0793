// Triangles near a place, against a look at every one.
#include "canyon/mission/collision/near_triangles.h"

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/surfaces/material.h"

namespace canyon::mission {
namespace {

/// Boxes turned every way on a sloping plain of that width, half of them within 20 m of its middle.
scene::SceneParts scattered(double half_m) {
  const RandomStream stream(4, "test.near");
  scene::SceneParts parts;
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-half_m, -half_m, -1}, {half_m, -half_m, 1}, {half_m, half_m, 1}, {-half_m, half_m, -1}, 0);
  mesh.begin_object("boxes", scene::ObjectKind::kOther);
  for (std::uint32_t k = 0; k < 200; ++k) {
    const double reach = k % 2 == 0 ? 20.0 : half_m;
    const Eigen::Vector3d at(stream.uniform(-reach, reach, 0, k), stream.uniform(-reach, reach, 1, k),
                             stream.uniform(0, 4, 2, k));
    mesh.box(at, rotation_from({stream.uniform(-3, 3, 3, k), 0.3, 0.2}).toRotationMatrix(),
             {stream.uniform(0.1, 5, 4, k), stream.uniform(0.1, 5, 5, k), 1.0}, 0);
  }
  return parts;
}

/// At 200 places, some far from the one before.
void expect_all(const scene::SceneAt& at, double reach_m) {
  const RandomStream random(5, "test.near.places");
  NearTriangles finder(at);
  const scene::Mesh& mesh = at.scene().mesh();
  std::size_t found = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Eigen::Vector3d p(random.uniform(-reach_m, reach_m, 0, i), random.uniform(-reach_m, reach_m, 1, i),
                            random.uniform(0, 3, 2, i));
    const double max_m = random.uniform(0.1, 8.0, 3, i);
    std::vector<std::uint32_t> expected;
    const auto look = [&](std::uint32_t index, const scene::Triangle& t) {
      if ((t.closest_point(p) - p).norm() <= max_m) expected.push_back(index);
    };
    for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) look(k, scene::Triangle::of(mesh, k));
    auto index = static_cast<std::uint32_t>(mesh.triangles.size());
    for (const scene::Instance& instance : at.instances())
      for (std::uint32_t k = 0; k < instance.shape->mesh().triangles.size(); ++k) {
        const scene::Triangle t = scene::Triangle::of(instance.shape->mesh(), k);
        look(index++, {instance.X_WS * t.a, instance.X_WS * t.b, instance.X_WS * t.c});
      }
    const std::vector<NearTriangle>& near = finder.near(p, max_m);
    ASSERT_EQ(near.size(), expected.size()) << i;
    for (std::size_t k = 0; k < near.size(); ++k) EXPECT_EQ(near[k].index, expected[k]) << i;
    found += near.size();
  }
  EXPECT_GT(found, 100u);
}

TEST(NearTriangles, AreAllWithinReach) {
  const scene::Scene scene(scattered(100.0));
  scene::SceneAt at(scene);
  expect_all(at, 25.0);
  scene::SceneParts parts;
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("box", scene::ObjectKind::kVehicle);
  mesh.box({0, 0, 0.75}, Eigen::Matrix3d::Identity(), {2, 1, 0.75}, 0);
  const auto shape = std::make_shared<scene::RigidShape>("box", scene::ObjectKind::kVehicle, parts.mesh);
  at.set_instances({{shape, "one", {rotation_from({0.4, 0, 0}), {3, 4, 0}}},
                    {shape, "two", {rotation_from({-1.4, 0.1, 0}), {-5, 1, 0.5}}}});
  expect_all(at, 15.0);
}

// A plain of 3 km: what is gathered around one place is not around the next.
TEST(NearTriangles, AreFoundAnewWhereTheVehicleHasGoneFar) {
  const scene::Scene scene(scattered(1500.0));
  const scene::SceneAt at(scene);
  expect_all(at, 1490.0);
}

}  // namespace
}  // namespace canyon::mission
