// A million rays against a brute force in double precision that tries every triangle.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/random.h"
#include "scene/triangle.h"
#include "tests/lidar/lidar_scenes.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kLanes = scene::RayPacket::kRays;

struct Nearest {
  std::uint32_t triangle = scene::Hit::kMiss;
  double range_m = std::numeric_limits<double>::infinity();
};

/// Moeller and Trumbore 1997, in double precision.
Nearest nearest(const std::vector<scene::Triangle>& triangles, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
  Nearest best;
  for (std::uint32_t k = 0; k < triangles.size(); ++k) {
    const scene::Triangle& t = triangles[k];
    const Eigen::Vector3d ab = t.b - t.a, ac = t.c - t.a, p = d.cross(ac);
    const double determinant = ab.dot(p);
    if (determinant == 0) continue;
    const Eigen::Vector3d ao = o - t.a, q = ao.cross(ab);
    const double u = ao.dot(p) / determinant, v = d.dot(q) / determinant, range_m = ac.dot(q) / determinant;
    if (u < 0 || v < 0 || u + v > 1 || range_m <= 0 || range_m >= best.range_m) continue;
    best = {k, range_m};
  }
  return best;
}

double distance_to_edges(const scene::Triangle& t, const Eigen::Vector3d& p) {
  double least = 1e300;
  const Eigen::Vector3d corners[] = {t.a, t.b, t.c};
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d &a = corners[k], &b = corners[(k + 1) % 3];
    const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    least = std::min(least, (a + s * (b - a) - p).norm());
  }
  return least;
}

TEST(Oracle, AMillionRaysDifferAtEdgesOnly) {
  const scene::Scene scene(testing::street_crossing());
  const scene::SceneAt at(scene);
  std::vector<scene::Triangle> triangles;
  for (std::uint32_t k = 0; k < scene.mesh().triangles.size(); ++k)
    triangles.push_back(scene::Triangle::of(scene.mesh(), k));
  const RandomStream random(3, "test.oracle");
  constexpr std::size_t kRays = 1'000'000, kBatch = 1000 * kLanes;
  std::vector<scene::RayPacket> rays(kBatch / kLanes);
  std::vector<scene::HitPacket> hits(rays.size());
  std::size_t compared = 0, met = 0, at_edges = 0;
  double worst_m = 0;
  for (std::size_t batch = 0; compared < kRays; ++batch) {
    for (std::size_t i = 0; i < kBatch; ++i) {
      const auto n = static_cast<std::uint64_t>(batch * kBatch + i);
      const Eigen::Vector3f o(static_cast<float>(random.uniform(-6, 6, 0, n)),
                              static_cast<float>(random.uniform(-6, 6, 1, n)),
                              static_cast<float>(random.uniform(0.5, 3, 2, n)));
      const Eigen::Vector3f d = random.direction(3, n).cast<float>();
      scene::RayPacket& packet = rays[i / kLanes];
      const std::size_t lane = i % kLanes;
      packet.origin_x[lane] = o.x(), packet.origin_y[lane] = o.y(), packet.origin_z[lane] = o.z();
      packet.direction_x[lane] = d.x(), packet.direction_y[lane] = d.y(), packet.direction_z[lane] = d.z();
      packet.max_m[lane] = 500;
    }
    at.trace(rays, hits);
    for (std::size_t i = 0; i < kBatch && compared < kRays; ++i, ++compared) {
      const scene::RayPacket& packet = rays[i / kLanes];
      const std::size_t lane = i % kLanes;
      const Eigen::Vector3d o(packet.origin_x[lane], packet.origin_y[lane], packet.origin_z[lane]);
      const Eigen::Vector3d d(packet.direction_x[lane], packet.direction_y[lane], packet.direction_z[lane]);
      const Nearest expected = nearest(triangles, o, d);
      const std::uint32_t triangle = hits[i / kLanes].triangle[lane];
      const double range_m = hits[i / kLanes].range_m[lane];
      met += expected.triangle != scene::Hit::kMiss;
      if (triangle == expected.triangle) {
        // Rounded once to float: half a unit in the last place of the range; the brute force's own 1e-13.
        if (triangle != scene::Hit::kMiss) {
          ASSERT_NEAR(range_m, expected.range_m, expected.range_m * 6.1e-8 + 1e-9);
          worst_m = std::max(worst_m, std::abs(range_m - expected.range_m));
        }
        continue;
      }
      // Within 1 mm of an edge of what the one met and the other did not.
      const bool ours = range_m < expected.range_m;
      const Eigen::Vector3d p = o + std::min(range_m, expected.range_m) * d;
      ASSERT_LT(distance_to_edges(triangles[ours ? triangle : expected.triangle], p), 1e-3);
      ++at_edges;
    }
  }
  EXPECT_GT(met, kRays / 2);
  RecordProperty("differences_at_edges", static_cast<int>(at_edges));
  RecordProperty("worst_range_um", std::to_string(1e6 * worst_m));
  std::printf("%zu rays, %zu met something, %zu differences, all within 1 mm of an edge; worst range %.2f um\n",
              compared, met, at_edges, 1e6 * worst_m);
  // Single precision resolves 2e-6 m here; the edges of a few hundred metres cover less than 1e-5 of the directions.
  EXPECT_LT(at_edges, 100u);
}

}  // namespace
}  // namespace canyon::lidar
