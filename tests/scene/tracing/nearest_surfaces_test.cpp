#include "canyon/scene/tracing/nearest_surfaces.h"

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/random/random.h"
#include "canyon/scene/city/city.h"
#include "canyon/tests/scene/small_scenes.h"

namespace canyon::scene::testing {
namespace {

std::vector<Eigen::Vector3f> points_near_the_ground(const Scene& scene, std::uint32_t count) {
  const RandomStream stream(5, "test.nearest_surfaces");
  std::vector<Eigen::Vector3f> out;
  for (std::uint32_t i = 0; i < count; ++i) {
    // Half of them crowd about a few places, so that blocks hold many.
    const double spread = i % 2 == 0 ? 480.0 : 3.0, x = stream.uniform(-spread, spread, 0, i),
                 y = stream.uniform(-spread, spread, 1, i);
    out.emplace_back(x, y, scene.ground(x, y)->height_m + stream.uniform(-2, 12, 2, i));
  }
  return out;
}

TEST(NearestSurfaces, AreThoseOfEachPointByItself) {
  const Scene scene(make_city({}));
  const SceneAt at(scene);
  const auto points = points_near_the_ground(scene, 3000);
  for (const double max_m : {0.5, 5.0, 60.0}) {
    const auto found = nearest_surfaces(scene, points, max_m);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const NearestSurface alone = at.nearest(points[i].cast<double>(), max_m);
      ASSERT_EQ(found[i].triangle, alone.triangle) << i << ' ' << points[i].transpose();
      ASSERT_EQ(found[i].distance_m, alone.distance_m) << i;
      ASSERT_EQ(found[i].point_W, alone.point_W) << i;
    }
  }
}

TEST(NearestSurfaces, TheSameForAnyNumberOfThreads) {
  const Scene scene(make_city({}));
  const auto points = points_near_the_ground(scene, 2000);
  std::vector<NearestSurface> first;
  for (const int n : {1, 2, 8}) {
    set_threads(n);
    const auto found = nearest_surfaces(scene, points, 5.0);
    if (first.empty()) first = found;
    for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(found[i].point_W, first[i].point_W);
  }
  set_threads(0);
}

TEST(NearestSurfaces, NoPointsNoSurfacesAndPointsFarOut) {
  SceneParts parts = empty_parts();
  MeshBuilder mesh(parts);
  mesh.begin_object("box", ObjectKind::kOther);
  mesh.box({0, 0, 0}, Eigen::Matrix3d::Identity(), {1, 2, 3}, 0);
  const Scene scene(std::move(parts));
  EXPECT_TRUE(nearest_surfaces(scene, {}, 5.0).empty());
  const std::vector<Eigen::Vector3f> points{{4.125F, 0.5F, 0.25F}, {1e8F, 0, 0}, {-1e8F, 0, 0}};
  const auto at_reach = nearest_surfaces(scene, points, 3.125);
  EXPECT_EQ(at_reach[0].distance_m, 3.125) << "a surface at exactly max_m counts";
  EXPECT_EQ(at_reach[1].triangle, Hit::kMiss);
  EXPECT_EQ(nearest_surfaces(scene, points, 3.0)[0].triangle, Hit::kMiss);
  const std::vector<Eigen::Vector3f> bad{{std::numeric_limits<float>::quiet_NaN(), 0, 0}};
  EXPECT_THROW(nearest_surfaces(scene, bad, 1.0), ProgramError);
}

}  // namespace
}  // namespace canyon::scene::testing
