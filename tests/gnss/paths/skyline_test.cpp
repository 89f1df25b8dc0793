#include "canyon/gnss/paths/skyline.h"

#include <numeric>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/paths/wall_scene.h"

namespace canyon::gnss {
namespace {

using testing::WallScene;

// What the skyline says is hidden is: no point of the facet is seen from there. Half of what is hidden behind one wall
// that fills its sectors must be found, or it would be of no use.
TEST(Skyline, WhatItHidesCannotBeSeen) {
  const RandomStream random(9, "test.skyline");
  std::size_t hidden = 0, unseen = 0;
  for (std::uint64_t trial = 0; trial < 8; ++trial) {
    WallScene walls;
    for (std::uint64_t i = 0; i < 60; ++i) {
      const auto at = [&](double low, double high, std::uint32_t n) {
        return random.uniform(low, high, n, 100 * trial + i);
      };
      const double x = at(-150, 150, 0), y = at(-150, 150, 1);
      if (std::hypot(x, y) < 25.0) continue;
      walls.box({x, y, at(-1, 3, 2)}, {x + at(4, 25, 3), y + at(4, 25, 4), at(5, 40, 5)});
    }
    const auto scene = walls.build();
    const scene::SceneAt now(*scene);
    const auto& facets = scene->facets().facets();
    std::vector<std::uint32_t> all(facets.size());
    std::iota(all.begin(), all.end(), 0u);
    const Eigen::Vector3d p(0.0, 0.0, 2.0);
    const Skyline skyline(p, facets, all);
    for (const auto& f : facets) {
      bool seen = false;
      for (std::uint64_t k = 0; k < 50 && !seen; ++k) {
        const double u = random.uniform(0.01, 0.99, 7, k), v = random.uniform(0.01, 0.99, 8, k);
        const Eigen::Vector3d q = f.rectangle_W[0] + u * (f.rectangle_W[1] - f.rectangle_W[0]) +
                                  v * (f.rectangle_W[3] - f.rectangle_W[0]) + 0.01 * f.normal_W;
        seen = f.normal_W.dot(p) > f.offset_m && !now.blocked(p, q);
      }
      const bool hides = skyline.hides(f);
      EXPECT_FALSE(hides && seen) << "facet at " << f.center_W.transpose();
      hidden += hides ? 1u : 0u;
      unseen += f.normal_W.dot(p) > f.offset_m && !seen ? 1u : 0u;
    }
  }
  EXPECT_GT(unseen, 100u);
  EXPECT_GT(hidden, unseen / 2);
}

// One wall, closed form: 20 m wide and 10 m above the antenna at 20 m. What stands behind it and below its top's lowest
// elevation is hidden; what rises above, looks out at a side or stands in front is not.
TEST(Skyline, OneWall) {
  WallScene walls;
  walls.wall({-10, 20, 0}, {20, 0, 0}, {0, 0, 12});   // 0: the wall
  walls.wall({-5, 40, 0}, {10, 0, 0}, {0, 0, 18});    // 1: 16 m over 40 m, 0.4; the wall's top at its far end: 0.447
  walls.wall({-5, 60, 0}, {10, 0, 0}, {0, 0, 32.5});  // 2: 0.508, more than the 0.5 of the wall's nearest point
  walls.wall({15, 40, 0}, {10, 0, 0}, {0, 0, 15});    // 3: looks out
  walls.wall({-5, 10, 0}, {10, 0, 0}, {0, 0, 3});     // 4: in front
  const auto scene = walls.build();
  const auto& facets = scene->facets().facets();
  ASSERT_EQ(facets.size(), 5u);
  const std::vector<std::uint32_t> the_wall{0};
  const Skyline skyline({0, 0, 2}, facets, the_wall);
  const bool expected[] = {false, true, false, false, false};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(skyline.hides(facets[i]), expected[i]) << i;
}

}  // namespace
}  // namespace canyon::gnss
