#include "canyon/scene/surfaces/triangulate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"

namespace canyon::scene {
namespace {

using Ring = std::vector<Eigen::Vector2d>;

/// Area and corners used; every triangle must be counter-clockwise.
double check(const std::vector<Ring>& rings, std::set<std::uint32_t>* used = nullptr) {
  std::vector<Eigen::Vector2d> points;
  for (const Ring& ring : rings) points.insert(points.end(), ring.begin(), ring.end());
  double twice = 0.0;
  for (const auto& t : triangulate(rings)) {
    const double area = twice_area({points[t[0]], points[t[1]], points[t[2]]});
    EXPECT_GT(area, 0.0);
    twice += area;
    if (used != nullptr) used->insert(t.begin(), t.end());
  }
  return 0.5 * twice;
}

TEST(Triangulate, KeepsTheAreaAndEveryCorner) {
  EXPECT_NEAR(check({{{0, 0}, {2, 0}, {2, 1}, {0, 1}}}), 2.0, 1e-12);
  EXPECT_NEAR(check({{{0, 1}, {2, 1}, {2, 0}, {0, 0}}}), 2.0, 1e-12);  // clockwise
  // An L with corners along its sides.
  std::set<std::uint32_t> used;
  EXPECT_NEAR(check({{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 1}}}, &used), 3.0, 1e-12);
  EXPECT_EQ(used.size(), 8u);
}

TEST(Triangulate, CutsHoles) {
  const Ring outer{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  EXPECT_NEAR(check({outer, {{2, 2}, {4, 2}, {4, 4}, {2, 4}}}), 96.0, 1e-12);
  EXPECT_NEAR(
      check({outer, {{2, 2}, {2, 4}, {4, 4}, {4, 2}}, {{5, 2}, {8, 2}, {8, 8}, {5, 8}}, {{1, 6}, {3, 6}, {2, 9}}}),
      100.0 - 4.0 - 18.0 - 3.0, 1e-12);
}

/// Stars with many corners, each with a hole like it, at the coordinates of a map: areas to rounding.
TEST(Triangulate, RandomStarsAtTheCoordinatesOfAMap) {
  const RandomStream random(3, "test.stars");
  for (std::uint32_t star = 0; star < 50; ++star) {
    Ring outer, hole;
    constexpr int kCorners = 60;
    for (int i = 0; i < kCorners; ++i) {
      const double angle = 2 * std::numbers::pi * i / kCorners,
                   r = random.uniform(20.0, 60.0, star, static_cast<std::uint64_t>(i));
      const Eigen::Vector2d d(std::cos(angle), std::sin(angle)), at(1841205.5, 5176065.2);
      outer.push_back(at + r * d);
      hole.push_back(at + random.uniform(1.0, 15.0, star, static_cast<std::uint64_t>(i), 1) * d);
    }
    const double expected = 0.5 * (std::abs(twice_area(outer)) - std::abs(twice_area(hole)));
    EXPECT_NEAR(check({outer, hole}), expected, 1e-9 * expected + 1e-6) << star;
  }
}

TEST(Triangulate, DegenerateRings) {
  EXPECT_TRUE(triangulate(std::vector<Ring>{}).empty());
  EXPECT_TRUE(triangulate(std::vector<Ring>{{{0, 0}, {1, 1}}}).empty());
  EXPECT_TRUE(triangulate(std::vector<Ring>{{{0, 0}, {1, 1}, {2, 2}}}).empty());
  EXPECT_TRUE(triangulate(std::vector<Ring>{{{0, 0}, {std::nan(""), 1}, {2, 2}}}).empty());
  EXPECT_NEAR(check({{{0, 0}, {0, 0}, {2, 0}, {2, 1}, {2, 1}, {0, 1}}}), 2.0, 1e-12);  // repeated corners
  check({{{0, 0}, {2, 2}, {2, 0}, {0, 2}}});  // crosses itself: ends, and faces one way
}

TEST(Triangulate, InSpaceKeepsTheSense) {
  const std::vector<Eigen::Vector3d> wall{{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 0, 3}};
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& t : triangulate(std::vector<std::vector<Eigen::Vector3d>>{wall}))
    sum += 0.5 * (wall[t[1]] - wall[t[0]]).cross(wall[t[2]] - wall[t[0]]);
  EXPECT_LT((sum - Eigen::Vector3d(0, -12, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace canyon::scene
