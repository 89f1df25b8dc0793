#include "canyon/scene/ground/ground_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "canyon/core/random/random.h"

/// The ground of imported scenes: full detail where things stand, larger cells elsewhere, and no cracks between them.
namespace canyon::scene::testing {
namespace {

double hills(const Eigen::Vector2d& p) {
  return 20.0 * std::sin(3e-4 * p.x()) * std::cos(2e-4 * p.y());
}

GroundDetail detail_at(const std::vector<Eigen::Vector2d>& places) {
  GroundDetail detail;
  for (const Eigen::Vector2d& p : places) detail.add(p, p + Eigen::Vector2d(20.0, 12.0));
  return detail;
}

std::vector<Eigen::Vector2d> scattered(double half_m, std::uint64_t count) {
  const RandomStream stream(4, "test.ground");
  std::vector<Eigen::Vector2d> out;
  for (std::uint64_t i = 0; i < count; ++i)
    out.emplace_back(stream.uniform(-half_m, half_m, 0, i), stream.uniform(-half_m, half_m, 1, i));
  return out;
}

constexpr double kNoLimit = 1e8;

// 2026-11-22: the ground was a regular grid over the bounding box. Where all is near what stands it still is, in the
// same order.
TEST(GroundSurface, InFullDetailItIsTheRegularGrid) {
  const GroundWish wish{{-83.0, -41.0}, {92.0, 64.0}, 5.0, 500.0};
  const GroundPlan plan(wish, detail_at({{0, 0}}), hills, kNoLimit);
  const GroundMesh ground(plan);
  const int columns = 36, rows = 22;  // -85 to 95, -45 to 65
  ASSERT_EQ(ground.places.size(), static_cast<std::size_t>(columns + 1) * (rows + 1));
  ASSERT_EQ(ground.triangles.size(), static_cast<std::size_t>(2 * columns * rows));
  EXPECT_EQ(plan.cells(), columns * rows);
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c)
      EXPECT_EQ(ground.places[static_cast<std::size_t>(r * (columns + 1) + c)],
                Eigen::Vector2d(-85.0 + 5.0 * c, -45.0 + 5.0 * r));
  const std::array<std::uint32_t, 3> first{0, 1, 38}, second{0, 38, 37};
  EXPECT_EQ(ground.triangles[0], first);
  EXPECT_EQ(ground.triangles[1], second);
}

/// Every side of a triangle is the side of one other triangle that runs the other way, or lies on the outer border.
TEST(GroundSurface, HasNoCracks) {
  const double half_m = 5.0 * 4096;  // 8192 cells: the root is the rectangle, nothing reaches beyond
  const GroundWish wish{{-half_m, -half_m}, {half_m, half_m}, 5.0, 60.0};
  const GroundPlan plan(wish, detail_at(scattered(0.9 * half_m, 40)), hills, kNoLimit);
  GroundMesh ground(plan);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  double area_m2 = 0.0;
  for (const auto& t : ground.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
    const Eigen::Vector2d a = ground.places[t[1]] - ground.places[t[0]], b = ground.places[t[2]] - ground.places[t[0]];
    const double twice = a.x() * b.y() - a.y() * b.x();
    EXPECT_GT(twice, 0.0);  // all look up
    area_m2 += 0.5 * twice;
  }
  EXPECT_EQ(area_m2, 4.0 * half_m * half_m);  // sums of whole squares: exact
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1);
    if (sides.contains({side.second, side.first})) continue;
    const Eigen::Vector2d &a = ground.places[side.first], &b = ground.places[side.second];
    const bool border = (std::abs(a.x()) == half_m && a.x() == b.x()) || (std::abs(a.y()) == half_m && a.y() == b.y());
    EXPECT_TRUE(border) << a.transpose() << " to " << b.transpose();
  }
  // 67 million cells of 5 m, of which those near what stands are there.
  EXPECT_LT(ground.triangles.size(), 400000u);
}

/// Height of the mesh at a place, by looking at every triangle; NaN outside.
double height_at(const GroundMesh& ground, const Eigen::Vector2d& p) {
  for (const auto& t : ground.triangles) {
    const Eigen::Vector2d &a = ground.places[t[0]], &b = ground.places[t[1]], &c = ground.places[t[2]];
    const double det = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    const double v = ((p.x() - a.x()) * (c.y() - a.y()) - (p.y() - a.y()) * (c.x() - a.x())) / det;
    const double w = ((b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x())) / det;
    if (v < -1e-12 || w < -1e-12 || v + w > 1.0 + 1e-12) continue;
    return (1.0 - v - w) * ground.height_m[t[0]] + v * ground.height_m[t[1]] + w * ground.height_m[t[2]];
  }
  return std::nan("");
}

TEST(GroundSurface, SeenFromWhatStandsItIsOffByAMilliradianAtMost) {
  const std::vector<Eigen::Vector2d> places = scattered(9000.0, 12);
  const GroundWish wish{{-9500, -9500}, {9500, 9500}, 5.0, 60.0};
  const GroundPlan plan(wish, detail_at(places), hills, kNoLimit);
  GroundMesh ground(plan);
  ASSERT_TRUE(fill_ground(ground, [](const Eigen::Vector2d& p) { return hills(p); }));
  const RandomStream stream(5, "test.ground_points");
  double worst = 0.0;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const Eigen::Vector2d p(stream.uniform(-9500, 9500, 0, i), stream.uniform(-9500, 9500, 1, i));
    double d = 1e300;
    for (const Eigen::Vector2d& at : places) d = std::min(d, (p - at).norm());
    // kSlope d at the samples. Between them, a quarter of an edge apart and that at most d / 1.5 long, chords of a
    // surface whose curvature is 20 (3e-4)^2 at most lie off by (d / 6)^2 / 8 of it along each axis.
    const double bound_m = GroundPlan::kSlope * d + 2.0 * (d / 6.0) * (d / 6.0) / 8.0 * 20.0 * 9e-8 + 1e-3;
    const double off_m = std::abs(height_at(ground, p) - hills(p));
    EXPECT_LE(off_m, bound_m) << p.transpose();
    worst = std::max(worst, off_m / d);
  }
  std::printf("  largest error over distance: %.2g rad, %zu triangles\n", worst, ground.triangles.size());
  // Beside what stands the cells are those of full detail: corners every 5 m.
  const Eigen::Vector2d near(std::round(places[0].x() / 5.0) * 5.0, std::round(places[0].y() / 5.0) * 5.0);
  EXPECT_NE(std::find(ground.places.begin(), ground.places.end(), near), ground.places.end());
}

TEST(GroundSurface, WhatIsNotKnownTakesTheMeanOfWhatIsBesideIt) {
  const GroundWish wish{{0, 0}, {100, 100}, 5.0, 500.0};
  const GroundPlan plan(wish, detail_at({{50, 50}}), hills, kNoLimit);
  GroundMesh ground(plan);
  const auto known = [](const Eigen::Vector2d& p) {
    const bool hole = p.x() > 30.0 && p.x() < 50.0 && p.y() > 30.0 && p.y() < 40.0;
    return hole ? std::nullopt : std::optional<double>(0.1 * p.x());
  };
  ASSERT_TRUE(fill_ground(ground, known));
  for (std::size_t i = 0; i < ground.places.size(); ++i)  // within what is around the hole, 3 to 5 m
    EXPECT_NEAR(ground.height_m[i], 0.1 * ground.places[i].x(), 1.0) << ground.places[i].transpose();
  EXPECT_FALSE(fill_ground(ground, [](const Eigen::Vector2d&) { return std::optional<double>(); }));
}

// 2026-11-22: one point far from the others made rings upon rings of empty buckets.
TEST(GroundSurface, AFitIsTheSameFromFarAwayAndKeepsAPlane) {
  std::vector<Eigen::Vector3d> heights;
  for (int i = 0; i < 50; ++i) heights.emplace_back(2000.0 * i, 0.001 * i, 7.0);
  const GroundFit fit(heights);
  EXPECT_NEAR(fit({51234.0, 60000.0}), 7.0, 1e-9);
  EXPECT_NEAR(fit({-90000.0, 10.0}), 7.0, 1e-9);
  EXPECT_EQ(GroundFit({})({3.0, 4.0}), 0.0);
}

}  // namespace
}  // namespace canyon::scene::testing
