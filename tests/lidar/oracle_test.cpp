// Rays by the million against a brute force in double precision that tries every triangle.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <mutex>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/process/parallel.h"
#include "canyon/core/process/vector_clones.h"
#include "canyon/core/random/random.h"
#include "canyon/scene/city/city.h"
#include "canyon/scene/surfaces/triangle.h"
#include "canyon/tests/lidar/lidar_scenes.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kLanes = scene::RayPacket::kRays;

struct Corners {
  double ax, ay, az, abx, aby, abz, acx, acy, acz;
};

struct Nearest {
  double range_m[kLanes], triangle[kLanes];  ///< a number that counts triangles is exact in double precision
};

/// Moeller and Trumbore 1997, in double precision: sixteen rays against every triangle.
CANYON_VECTOR_CLONES void try_all(const Corners* triangles, std::size_t count, const scene::RayPacket& rays,
                                  Nearest& out) {
  double ox[kLanes], oy[kLanes], oz[kLanes], dx[kLanes], dy[kLanes], dz[kLanes], best_m[kLanes], best[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) {
    ox[i] = rays.origin_x[i], oy[i] = rays.origin_y[i], oz[i] = rays.origin_z[i];
    dx[i] = rays.direction_x[i], dy[i] = rays.direction_y[i], dz[i] = rays.direction_z[i];
    best_m[i] = std::numeric_limits<double>::infinity();
    best[i] = -1.0;
  }
  for (std::size_t k = 0; k < count; ++k) {
    const Corners t = triangles[k];
    const auto number = static_cast<double>(static_cast<std::int64_t>(k));
    for (std::size_t i = 0; i < kLanes; ++i) {
      const double px = dy[i] * t.acz - dz[i] * t.acy, py = dz[i] * t.acx - dx[i] * t.acz,
                   pz = dx[i] * t.acy - dy[i] * t.acx;
      const double inverse = 1.0 / (t.abx * px + t.aby * py + t.abz * pz);  // in its plane: infinite, and no hit
      const double sx = ox[i] - t.ax, sy = oy[i] - t.ay, sz = oz[i] - t.az;
      const double qx = sy * t.abz - sz * t.aby, qy = sz * t.abx - sx * t.abz, qz = sx * t.aby - sy * t.abx;
      const double u = (sx * px + sy * py + sz * pz) * inverse, v = (dx[i] * qx + dy[i] * qy + dz[i] * qz) * inverse;
      const double range_m = (t.acx * qx + t.acy * qy + t.acz * qz) * inverse;
      const bool nearer = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (range_m > 0.0) & (range_m < best_m[i]);
      best_m[i] = nearer ? range_m : best_m[i];
      best[i] = nearer ? number : best[i];
    }
  }
  for (std::size_t i = 0; i < kLanes; ++i) out.range_m[i] = best_m[i], out.triangle[i] = best[i];
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

struct Outcome {
  std::size_t met = 0, at_edges = 0;
  double worst_m = 0;
};

/// Rays every way from origins that `place` gives by number. Where both meet the same plane, ranges agree to rounding;
/// else the ray passes within 1 mm of an edge of what one met and the other did not.
template <class Place>
Outcome compare(const scene::Scene& scene, std::size_t packets, const Place& place) {
  const scene::SceneAt at(scene);
  std::vector<Corners> corners;
  for (std::uint32_t k = 0; k < scene.mesh().triangles.size(); ++k) {
    const scene::Triangle t = scene::Triangle::of(scene.mesh(), k);
    const Eigen::Vector3d ab = t.b - t.a, ac = t.c - t.a;
    corners.push_back({t.a.x(), t.a.y(), t.a.z(), ab.x(), ab.y(), ab.z(), ac.x(), ac.y(), ac.z()});
  }
  const RandomStream random(3, "test.oracle");
  Outcome total;
  std::mutex mutex;
  parallel_for(packets, 64, [&](std::size_t begin, std::size_t end) {
    Outcome part;
    for (std::size_t p = begin; p < end; ++p) {
      std::array<scene::RayPacket, 1> rays;
      std::array<scene::HitPacket, 1> hits;
      for (std::size_t i = 0; i < kLanes; ++i) {
        const std::uint64_t n = p * kLanes + i;
        const Eigen::Vector3f o = place(random, n).template cast<float>();
        const Eigen::Vector3f d = random.direction(3, n).cast<float>();
        rays[0].origin_x[i] = o.x(), rays[0].origin_y[i] = o.y(), rays[0].origin_z[i] = o.z();
        rays[0].direction_x[i] = d.x(), rays[0].direction_y[i] = d.y(), rays[0].direction_z[i] = d.z();
        rays[0].max_m[i] = std::numeric_limits<float>::infinity();
      }
      at.trace(rays, hits);
      Nearest expected;
      try_all(corners.data(), corners.size(), rays[0], expected);
      for (std::size_t i = 0; i < kLanes; ++i) {
        const double range_m = hits[0].range_m[i], expected_m = expected.range_m[i];
        part.met += expected.triangle[i] >= 0 ? 1 : 0;
        const bool met = expected.triangle[i] >= 0, hit = hits[0].triangle[i] != scene::Hit::kMiss;
        if (!met && !hit) continue;
        const Eigen::Vector3d o(rays[0].origin_x[i], rays[0].origin_y[i], rays[0].origin_z[i]);
        const Eigen::Vector3d d(rays[0].direction_x[i], rays[0].direction_y[i], rays[0].direction_z[i]);
        const auto triangle_of = [&](bool ours) {
          return scene::Triangle::of(scene.mesh(),
                                     ours ? hits[0].triangle[i] : static_cast<std::uint32_t>(expected.triangle[i]));
        };
        const double off_m = std::abs(range_m - expected_m);
        // Rounded once to float: half a unit in the last place of the range; the brute force's own 1e-9.
        if (met && hit && off_m <= expected_m * 6.1e-8 + 1e-9) {
          part.worst_m = std::max(part.worst_m, off_m);
          // Another triangle at the same range: the point lies in it as well, to the tracer's resolution.
          const Eigen::Vector3d point = o + expected_m * d;
          if (hits[0].triangle[i] != static_cast<std::uint32_t>(expected.triangle[i])) {
            EXPECT_LT((triangle_of(true).closest_point(point) - point).norm(), 1e-3) << "ray " << p * kLanes + i;
          }
          continue;
        }
        const bool ours = range_m < expected_m;
        EXPECT_LT(distance_to_edges(triangle_of(ours), o + std::min(range_m, expected_m) * d), 1e-3)
            << "ray " << p * kLanes + i << ": " << range_m << " m, brute force " << expected_m << " m";
        ++part.at_edges;
      }
    }
    const std::lock_guard lock(mutex);
    total.met += part.met, total.at_edges += part.at_edges;
    total.worst_m = std::max(total.worst_m, part.worst_m);
  });
  std::printf(
      "%zu rays, %zu triangles: %zu met something, %zu differences, all within 1 mm of an edge; worst range "
      "%.2f um\n",
      packets * kLanes, corners.size(), total.met, total.at_edges, 1e6 * total.worst_m);
  return total;
}

TEST(Oracle, AMillionRaysDifferAtEdgesOnly) {
  const scene::Scene scene(testing::street_crossing());
  const Outcome out = compare(scene, 62'500, [](const RandomStream& random, std::uint64_t n) -> Eigen::Vector3d {
    return {random.uniform(-6, 6, 0, n), random.uniform(-6, 6, 1, n), random.uniform(0.5, 3, 2, n)};
  });
  EXPECT_GT(out.met, 500'000u);
  // Single precision resolves 2e-6 m here; the edges of a few hundred metres cover less than 1e-5 of the directions.
  EXPECT_LE(out.at_edges, 10u);
}

/// The built-in city of half a million triangles, from everywhere in it, up to 20 m above the ground.
TEST(OracleNightly, AHundredThousandRaysInTheCity) {
  const scene::Scene scene(scene::make_city({}));
  const Outcome out = compare(scene, 6'250, [&](const RandomStream& random, std::uint64_t n) -> Eigen::Vector3d {
    const double x = random.uniform(-450, 450, 0, n), y = random.uniform(-450, 450, 1, n);
    return {x, y, scene.ground(x, y)->height_m + random.uniform(0.5, 20, 2, n)};
  });
  EXPECT_GT(out.met, 50'000u);
  // Single precision resolves 3e-5 m here, to both sides of 3 m of edge in a square metre (triangles of 2 m): that is
  // passed by 2e-4 of the rays, twenty.
  EXPECT_LE(out.at_edges, 20u);
}

}  // namespace
}  // namespace canyon::lidar
