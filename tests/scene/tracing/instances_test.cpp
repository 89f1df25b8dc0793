#include "canyon/scene/tracing/instances.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/scene/small_scenes.h"

namespace canyon::scene::testing {
namespace {

/// A closed box of 4 x 2 x 1.5 m on the ground of S.
std::shared_ptr<const RigidShape> box_shape(std::uint16_t material) {
  SceneParts parts = empty_parts();
  MeshBuilder mesh(parts);
  mesh.begin_object("box", ObjectKind::kVehicle);
  mesh.box({0, 0, 0.75}, Eigen::Matrix3d::Identity(), {2, 1, 0.75}, material);
  return std::make_shared<RigidShape>("box", ObjectKind::kVehicle, parts.mesh);
}

Pose turned(double yaw_rad, const Eigen::Vector3d& p) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())), p};
}

TEST(Instances, StandWhereTheyArePut) {
  SceneParts parts = empty_parts();
  add_plane(parts, 50.0, 0.0);
  const std::uint16_t metal = MeshBuilder(parts).material("painted_metal");
  const Scene scene(std::move(parts));
  SceneAt at(scene);
  const Ray ray{{0, 0, 1}, {1, 0, 0}};
  EXPECT_FALSE(at.trace(ray).hit());

  at.set_instances(
      {{box_shape(metal), "car 1", turned(0.0, {10, 0, 0})}, {box_shape(metal), "car 2", turned(kPi / 2, {0, 20, 0})}});
  const Hit ahead = at.trace(ray);
  ASSERT_TRUE(ahead.hit());
  EXPECT_NEAR(ahead.range_m, 8.0, 2 * 8.0 * 6e-8);
  EXPECT_LT((ahead.normal - Eigen::Vector3f(-1, 0, 0)).norm(), 1e-6f);
  const SceneAt::Surface surface = at.surface(ahead.triangle);
  EXPECT_TRUE(surface.moving);
  EXPECT_EQ(surface.material, metal);
  EXPECT_EQ(at.object(surface.object).name, "car 1");
  EXPECT_EQ(at.object(surface.object).kind, ObjectKind::kVehicle);
  EXPECT_EQ(surface.object, scene.objects().size());

  // The second is turned: its 4 m lie along y.
  const Hit north = at.trace({{0, 0, 1}, {0, 1, 0}});
  EXPECT_NEAR(north.range_m, 18.0, 1e-5);
  EXPECT_EQ(at.object(at.surface(north.triangle).object).name, "car 2");
  // The ground is still the ground, and what it hides stays hidden.
  const Hit down = at.trace({{0, 0, 1}, {0, 0, -1}});
  EXPECT_FALSE(at.surface(down.triangle).moving);
  EXPECT_EQ(at.object(at.surface(down.triangle).object).name, "terrain");

  EXPECT_TRUE(at.blocked({0, 0, 1}, {20, 0, 1}));
  EXPECT_FALSE(at.blocked({0, 0, 1}, {7, 0, 1}));
  EXPECT_TRUE(at.blocked_towards({0, 0, 1}, {1, 0, 0}));

  // A copy keeps what it was made with; an empty list takes all away.
  const SceneAt copy = at;
  at.set_instances({});
  EXPECT_FALSE(at.trace(ray).hit());
  EXPECT_EQ(at.instances().size(), 0u);
  EXPECT_TRUE(copy.trace(ray).hit());
  EXPECT_EQ(copy.instances().size(), 2u);
}

/// Every ray against the same triangles baked into a static scene: the same object, and the range to the rounding of
/// single precision (rotated corners of the baked mesh are rounded: 4e-6 m at 50 m; at 1/cos(incidence) < 100).
TEST(Instances, AgreeWithABakedScene) {
  constexpr std::uint16_t concrete = 0;  // first of the table
  SceneParts parts = empty_parts(), baked = empty_parts();
  add_plane(parts, 60.0, 0.0);
  add_plane(baked, 60.0, 0.0);
  const RandomStream stream(7, "test.instances");
  std::vector<Instance> instances;
  const auto shape = box_shape(concrete);
  for (std::uint32_t i = 0; i < 12; ++i) {
    const Pose X = turned(stream.uniform(-kPi, kPi, i, 0),
                          {stream.uniform(-40, 40, i, 1), stream.uniform(-40, 40, i, 2), stream.uniform(0, 3, i, 3)});
    instances.push_back({shape, "box " + std::to_string(i), X});
    MeshBuilder mesh(baked);
    mesh.begin_object("box " + std::to_string(i), ObjectKind::kVehicle);
    mesh.box(X * Eigen::Vector3d(0, 0, 0.75), X.R.toRotationMatrix(), {2, 1, 0.75}, concrete);
  }
  const Scene fixed(std::move(parts)), all(std::move(baked));
  SceneAt moving(fixed);
  moving.set_instances(instances);
  const SceneAt still(all);

  constexpr std::size_t kRays = 20000;
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < kRays; ++i) {
    const Eigen::Vector3d origin(stream.uniform(-45, 45, 100, i), stream.uniform(-45, 45, 101, i), 1.7);
    rays.push_back({in_single_precision(origin),  // as a packet holds it
                    stream.direction(102, i).cast<float>().normalized()});
  }
  std::vector<Hit> hits(kRays);
  moving.trace(rays, hits);
  std::vector<RayPacket> packets(kRays / RayPacket::kRays);
  std::vector<HitPacket> packed(packets.size());
  for (std::size_t i = 0; i < packets.size() * RayPacket::kRays; ++i) {
    RayPacket& p = packets[i / RayPacket::kRays];
    const std::size_t lane = i % RayPacket::kRays;
    const Eigen::Vector3f origin = rays[i].origin.cast<float>();
    p.origin_x[lane] = origin.x(), p.origin_y[lane] = origin.y(), p.origin_z[lane] = origin.z();
    p.direction_x[lane] = rays[i].direction.x(), p.direction_y[lane] = rays[i].direction.y();
    p.direction_z[lane] = rays[i].direction.z();
    p.max_m[lane] = rays[i].max_m;
  }
  moving.trace(packets, packed);
  std::size_t on_instances = 0, differ = 0;
  for (std::size_t i = 0; i < kRays; ++i) {
    const Hit single = moving.trace(rays[i]), expected = still.trace(rays[i]);
    ASSERT_EQ(single.triangle, hits[i].triangle) << i;
    ASSERT_EQ(single.range_m, hits[i].range_m) << i;
    const HitPacket& packet = packed[i / RayPacket::kRays];
    ASSERT_EQ(packet.triangle[i % RayPacket::kRays], single.triangle) << i;
    if (single.hit()) {
      ASSERT_EQ(packet.range_m[i % RayPacket::kRays], single.range_m) << i;
      EXPECT_NEAR(packet.cos_incidence[i % RayPacket::kRays], std::abs(single.normal.dot(rays[i].direction)), 1e-6);
    }
    const auto name = [&](const SceneAt& at, const Hit& hit) {
      return hit.hit() ? at.object(at.surface(hit.triangle).object).name : std::string("nothing");
    };
    if (name(moving, single) != name(still, expected)) {
      ++differ;
      continue;
    }
    if (!single.hit()) continue;
    on_instances += moving.surface(single.triangle).moving;
    const double cosine = std::abs(expected.normal.dot(rays[i].direction));
    EXPECT_NEAR(single.range_m, expected.range_m, 2e-5 / std::max(cosine, 0.01)) << i;
  }
  EXPECT_GT(on_instances, 400u);  // enough to tell
  EXPECT_LE(differ, 4u);          // rays within single precision of a silhouette: 4e-6 m of some 100 m of it in view
}

TEST(Instances, WithoutThemHitsAreTheSameBits) {
  SceneParts parts = empty_parts();
  add_plane(parts, 50.0, 0.0);
  add_building(parts, rectangle(10, -5, 20, 5), 0.0, 12.0);
  const Scene scene(std::move(parts));
  const SceneAt plain(scene);
  SceneAt busy(scene);
  busy.set_instances({{box_shape(0), "far", turned(0.3, {500, 500, 0})}});
  const RandomStream stream(9, "test.instances");
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Ray ray{{0, 0, 2}, stream.direction(0, i).cast<float>()};
    const Hit a = plain.trace(ray), b = busy.trace(ray);
    ASSERT_EQ(a.triangle, b.triangle);
    ASSERT_EQ(a.range_m, b.range_m);
  }
}

TEST(Instances, DegenerateShapes) {
  SceneParts parts = empty_parts();
  const Scene scene(std::move(parts));
  SceneAt at(scene);
  at.set_instances({{std::make_shared<RigidShape>("nothing", ObjectKind::kOther, Mesh{}), "nothing", Pose{}}});
  EXPECT_FALSE(at.trace({{0, 0, 1}, {1, 0, 0}}).hit());
  const auto shape = box_shape(0);
  EXPECT_THROW(at.set_instances({{nullptr, "none", Pose{}}}), ProgramError);
  EXPECT_THROW(at.set_instances({{shape, "lost", turned(0, {std::nan(""), 0, 0})}}), ProgramError);
  EXPECT_THROW(at.set_instances({{box_shape(60000), "painted", Pose{}}}), ProgramError);
}

}  // namespace
}  // namespace canyon::scene::testing
