// Boxes against triangles: two other ways to the same answer.
#include "canyon/mission/collision/body_box.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"

namespace canyon::mission {
namespace {

using scene::Triangle;

Eigen::Vector3d any_point(const RandomStream& random, std::uint64_t i, std::uint32_t n, double size) {
  return {random.uniform(-size, size, n, i), random.uniform(-size, size, n + 1, i),
          random.uniform(-size, size, n + 2, i)};
}

/// Cuts the triangle by the box's six planes (Sutherland & Hodgman): what is left is what they have in common.
bool anything_left(const OrientedBox& box, const Triangle& t) {
  const Pose X_CW = box.X_WC.inverse();
  std::vector<Eigen::Vector3d> polygon{X_CW * t.a, X_CW * t.b, X_CW * t.c};
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) {
      std::vector<Eigen::Vector3d> inside;
      const auto depth = [&](const Eigen::Vector3d& p) { return box.half_m[axis] - side * p[axis]; };
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector3d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        if (depth(p) >= 0.0) inside.push_back(p);
        if (depth(p) * depth(q) < 0.0) inside.push_back(p + depth(p) / (depth(p) - depth(q)) * (q - p));
      }
      polygon = inside;
    }
  return !polygon.empty();
}

/// From a point of the one to the nearest of the other and back: never below the distance, and it comes down to it.
double by_projections(const OrientedBox& box, const Triangle& t) {
  const Pose X_CW = box.X_WC.inverse();
  const Triangle in_C{X_CW * t.a, X_CW * t.b, X_CW * t.c};
  Eigen::Vector3d p = (in_C.a + in_C.b + in_C.c) / 3.0, q = p;
  for (int k = 0; k < 4000; ++k) {
    q = p.cwiseMax(-box.half_m).cwiseMin(box.half_m);
    p = in_C.closest_point(q);
  }
  return (p - q).norm();
}

TEST(BodyBox, TouchesAndDistancesAreThoseOfOtherWays) {
  const RandomStream random(3, "test.body_box");
  int touching = 0, slow = 0;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    const OrientedBox box{
        {so3_exp(any_point(random, i, 0, 3.0)), any_point(random, i, 3, 50.0)},
        {random.uniform(0.2, 3.0, 6, i), random.uniform(0.2, 1.5, 7, i), random.uniform(0.2, 1.5, 8, i)}};
    const double size = random.uniform(0.1, 6.0, 9, i);
    const Eigen::Vector3d at = box.X_WC.p + any_point(random, i, 10, 4.0);
    const Triangle t{at + any_point(random, i, 13, size), at + any_point(random, i, 16, size),
                     at + any_point(random, i, 19, size)};
    const double distance = distance_m(box, t);
    EXPECT_EQ(touch(box, t), anything_left(box, t)) << i;
    EXPECT_EQ(distance == 0.0, touch(box, t)) << i;
    touching += touch(box, t) ? 1 : 0;
    const double other = by_projections(box, t);
    EXPECT_LE(distance, other + 1e-9) << i;
    slow += other - distance > 1e-3 ? 1 : 0;  // projections come near slowly where the two are nearly parallel
  }
  EXPECT_GT(touching, 300);
  EXPECT_LT(touching, 3000);
  EXPECT_LT(slow, 20);
}

// A gap along each separating axis by hand: faces, corner against face, edge against edge, in parallel, an edge that
// crosses none.
TEST(BodyBox, DistancesByHand) {
  const OrientedBox box{{}, {2.0, 1.0, 0.5}};
  const auto far = [&](const Triangle& t) { return distance_m(box, t); };
  EXPECT_DOUBLE_EQ(far({{2.5, -1, -1}, {2.5, 1, -1}, {2.5, 0, 1}}), 0.5);
  EXPECT_DOUBLE_EQ(far({{5, 4.0, 0}, {6, 4.0, 0}, {5, 5, 0}}), std::hypot(3.0, 3.0));
  EXPECT_DOUBLE_EQ(far({{-9, 0, 0.8}, {9, 0, 0.8}, {0, 9, 0.8}}), 0.3);
  EXPECT_DOUBLE_EQ(far({{3, 2, -9}, {3, 2, 9}, {9, 9, 0}}), std::hypot(1.0, 1.0)) << "two upright edges";
  EXPECT_DOUBLE_EQ(far({{2, 1, 0.5}, {5, 5, 5}, {5, 6, 5}}), 0.0) << "a corner on a corner";
  EXPECT_DOUBLE_EQ(far({{-100, 0, -100}, {100, 0, -100}, {0, 0, 100}}), 0.0) << "right through";
  EXPECT_DOUBLE_EQ(far({{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}), 0.0) << "inside";
}

TEST(BodyBox, IsTheBodyAboveItsClearance) {
  VehicleConfig vehicle;  // 2.6 x 1.5 x 1.6 m, 1.8 m between the axles
  const OrientedBox body = body_box(vehicle, {rotation_from({.yaw_rad = kPi / 2}), {10, 20, 5}});
  EXPECT_LT((body.X_WC.p - Eigen::Vector3d(10, 20.9, 5.9)).norm(), 1e-12);
  EXPECT_LT((body.half_m - Eigen::Vector3d(1.3, 0.75, 0.7)).norm(), 1e-15);
}

}  // namespace
}  // namespace canyon::mission
