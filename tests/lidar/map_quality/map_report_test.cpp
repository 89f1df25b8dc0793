#include "canyon/lidar/map_quality/map_report.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "canyon/core/process/parallel.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/lidar/map_quality/signed_distance.h"
#include "canyon/lidar/map_quality/true_points.h"
#include "canyon/scene/surfaces/triangle.h"
#include "canyon/tests/lidar/lidar_scenes.h"

namespace canyon::lidar {
namespace {

/// Nearest point of a triangle by its own means: the foot of the perpendicular if it falls inside, else the nearest of
/// the three edges.
double triangle_distance_m(const scene::Triangle& t, const Eigen::Vector3d& p) {
  const Eigen::Vector3d n = t.area_normal().normalized();
  const Eigen::Vector3d foot = p - n.dot(p - t.a) * n;
  const auto beside = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (b - a).cross(foot - a).dot(n);
  };
  if (beside(t.a, t.b) >= 0 && beside(t.b, t.c) >= 0 && beside(t.c, t.a) >= 0) return (p - foot).norm();
  double best = 1e300;
  const std::array<Eigen::Vector3d, 4> corners{t.a, t.b, t.c, t.a};
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d along = corners[i + 1] - corners[i];
    const double s = std::min(1.0, std::max(0.0, (p - corners[i]).dot(along) / along.squaredNorm()));
    best = std::min(best, (p - corners[i] - s * along).norm());
  }
  return best;
}

TEST(SignedDistance, EqualsBruteForceInDoubles) {
  const scene::Scene scene(testing::street_crossing());
  const SignedDistance surfaces(scene);
  const RandomStream random(3, "test.points");
  for (std::uint64_t i = 0; i < 10'000; ++i) {
    const Eigen::Vector3d p(random.uniform(-70, 70, 0, i), random.uniform(-70, 70, 1, i), random.uniform(-3, 20, 2, i));
    double best = 1e300;
    for (std::uint32_t t = 0; t < scene.mesh().triangles.size(); ++t)
      best = std::min(best, triangle_distance_m(scene::Triangle::of(scene.mesh(), t), p));
    const SurfaceOffset found = surfaces.at(p, 100.0);
    ASSERT_TRUE(found.found);
    ASSERT_NEAR(std::abs(found.distance_m), best, 1e-5) << p.transpose();
    ASSERT_NEAR(found.offset_W.norm(), best, 1e-5);
  }
}

/// Inside or outside of bodies is known without any surface.
TEST(SignedDistance, IsNegativeInsideOfBodies) {
  scene::SceneParts parts = testing::empty_parts();
  testing::add_box(parts, {0, 0, 0}, {2, 3, 1}, 0.3);
  testing::add_box(parts, {10, 0, 0}, {1, 1, 4}, -0.7);
  // A wedge: at its sharp edges the nearest triangle alone gives the wrong sign.
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("wedge", scene::ObjectKind::kBuilding);
  const Eigen::Vector3d a(20, 0, 0), b(24, 0, 0), c(20, 0.4, 0), d(20, 0, 3);
  mesh.triangle(a, c, b, 0);
  mesh.triangle(a, b, d, 0);
  mesh.triangle(a, d, c, 0);
  mesh.triangle(b, c, d, 0);
  const scene::Scene scene(parts);
  const SignedDistance surfaces(scene);
  const auto inside_box = [](const Eigen::Vector3d& p, const Eigen::Vector3d& center, const Eigen::Vector3d& half,
                             double yaw) {
    const Eigen::Vector3d q = rotation_from({.yaw_rad = yaw}).conjugate() * (p - center);
    return (q.cwiseAbs() - half).maxCoeff() < 0.0;
  };
  const Eigen::Vector3d slope = (c - b).cross(d - b);
  const auto inside_wedge = [&](const Eigen::Vector3d& p) {
    return p.x() > 20 && p.y() > 0 && p.z() > 0 && slope.dot(p - b) < 0.0;
  };
  const RandomStream random(5, "test.inside");
  int inside = 0;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    Eigen::Vector3d p(random.uniform(-5, 26, 0, i), random.uniform(-5, 5, 1, i), random.uniform(-5, 5, 2, i));
    if (i % 2 == 0)
      p = {random.uniform(19.5, 24.5, 0, i), random.uniform(-0.4, 0.8, 1, i), random.uniform(-1, 3.5, 2, i)};
    const SurfaceOffset found = surfaces.at(p, 100.0);
    if (std::abs(found.distance_m) < 1e-4) continue;  // single precision of the corners
    const bool within =
        inside_box(p, {0, 0, 0}, {2, 3, 1}, 0.3) || inside_box(p, {10, 0, 0}, {1, 1, 4}, -0.7) || inside_wedge(p);
    inside += within;
    ASSERT_EQ(found.distance_m < 0.0, within) << p.transpose();
  }
  EXPECT_GT(inside, 500);
}

/// Points every 0.2 m of the ground at a height, and of a wall at an offset.
std::vector<Eigen::Vector3f> sheet_and_wall(float ground_m, float wall_m) {
  std::vector<Eigen::Vector3f> out;
  for (int i = -50; i < 50; ++i)
    for (int k = 0; k < 50; ++k) {
      out.emplace_back(-0.2F * static_cast<float>(k) - 2.0F, 0.2F * static_cast<float>(i), ground_m);
      out.emplace_back(10.0F + wall_m, 0.2F * static_cast<float>(i), 1.5F + 0.2F * static_cast<float>(k));
    }
  return out;
}

scene::SceneParts ground_and_wall() {
  scene::SceneParts parts = testing::empty_parts();
  testing::add_ground(parts, 60);
  testing::add_wall(parts, {10, 60}, {10, -60}, 20);
  return parts;
}

TEST(MapReport, SplitsUpAndAcrossByMaterial) {
  const scene::Scene scene(ground_and_wall());
  const auto map = sheet_and_wall(0.08F, -0.12F);
  MapTruth truth;
  truth.sensor_W = {{0, 0, 2}};
  const MapReport r = report_map(map, scene, truth, 5.0, 0.5);
  EXPECT_EQ(r.points, 10'000);
  EXPECT_EQ(r.capped_points, 0);
  ASSERT_EQ(r.by_material.size(), 2U);
  for (const MapErrors& m : r.by_material) {
    const bool ground = m.name == "asphalt";
    EXPECT_EQ(m.points, 5000);
    // Single precision of places of 60 m.
    EXPECT_NEAR(m.up_rms_m, ground ? 0.08 : 0.0, 1e-5);
    EXPECT_NEAR(m.across_rms_m, ground ? 0.0 : 0.12, 1e-5);
    EXPECT_NEAR(std::abs(m.signed_mean_m), ground ? 0.08 : 0.12, 1e-5);
    if (ground) {
      EXPECT_GT(m.signed_mean_m, 0.0);
    }
  }
  EXPECT_NEAR(r.all.rms_m, std::sqrt((0.08 * 0.08 + 0.12 * 0.12) / 2), 1e-5);
  EXPECT_NEAR(r.level_up_rms_m, 0.08, 1e-5);
  EXPECT_EQ(r.accuracy, (std::array<double, 3>{0.0, 0.5, 1.0}));
  std::int64_t by_range = 0;
  for (const MapErrors& m : r.by_range) by_range += m.points;
  EXPECT_EQ(by_range, 10'000);
  EXPECT_EQ(r.by_range.front().name, "0 to 10 m");
  EXPECT_TRUE(std::isnan(r.completeness[0])) << "nothing is known of what should be there";
}

TEST(MapReport, CompletenessAndFScore) {
  const scene::Scene scene(ground_and_wall());
  auto map = sheet_and_wall(0.0F, 0.0F);
  MapTruth truth;
  truth.points_W = map;
  map.resize(map.size() / 2);                                    // half of what should be there
  for (std::size_t i = 0; i < 500; ++i) map[2 * i].z() = 0.15F;  // and a tenth of it is off
  const MapReport r = report_map(map, scene, truth, 5.0, 0.5);
  EXPECT_NEAR(r.accuracy[1], 0.9, 1e-12);
  EXPECT_NEAR(r.completeness[1], 0.45, 1e-12);
  EXPECT_NEAR(r.f_score[1], 2 * 0.9 * 0.45 / 1.35, 1e-12);
  EXPECT_NEAR(r.accuracy[2], 1.0, 1e-12);
  EXPECT_NEAR(r.completeness[2], 0.5, 0.011)
      << "points 0.2 m beside the border count or not, by rounding: 100 of 10,000";
}

TEST(MapReport, DoubledWallsAreFound) {
  const scene::Scene scene(ground_and_wall());
  auto map = sheet_and_wall(0.0F, -0.1F);
  const auto again = sheet_and_wall(0.0F, 0.25F);
  map.insert(map.end(), again.begin(), again.end());
  const MapReport doubled = report_map(map, scene, {}, 5.0, 0.5);
  EXPECT_NEAR(doubled.walls.median_m, 0.35, 1e-5);
  EXPECT_EQ(doubled.walls.doubled_share, 1.0);
  EXPECT_NEAR(doubled.walls.doubled_gap_median_m, 0.35, 1e-5);

  // One wall with normal noise is thick, not doubled: thickness 2 * 1.645 sigma; 45 patches of 100 points, the mean of
  // their quantiles within 2 %.
  std::vector<Eigen::Vector3f> noisy = sheet_and_wall(0.0F, 0.0F);
  const RandomStream random(11, "test.wall");
  for (std::size_t i = 0; i < noisy.size(); ++i) noisy[i].x() += 0.2F * static_cast<float>(random.normal(0, i));
  const MapReport thick = report_map(noisy, scene, {}, 5.0, 0.5);
  EXPECT_NEAR(thick.walls.median_m, 2 * 1.645 * 0.2, 0.05);
  EXPECT_LT(thick.walls.doubled_share, 0.05);
}

TEST(MapReport, EntropyOfNormalScatter) {
  // Isotropic normal points of sigma s, all of them neighbours of all: ln(det(2 pi e s^2 I)) / 2.
  const RandomStream random(13, "test.scatter");
  std::vector<Eigen::Vector3f> points;
  for (std::uint64_t i = 0; i < 4000; ++i) points.push_back((0.1 * random.normal3(i)).cast<float>());
  const SelfConsistency s = self_consistency(PointGrid(points, 5.0), 5.0);
  EXPECT_EQ(s.points, 4000);
  // A sample covariance of n: its log determinant has a sigma of sqrt(6 / n), half of it here; 4 sigma (6e-5), and a
  // bias of -6 / n.
  EXPECT_NEAR(s.mean_map_entropy, 1.5 * std::log(2 * kPi * std::exp(1.0) * 0.01),
              4 * 0.5 * std::sqrt(6.0 / 4000) + 0.002);
  EXPECT_NEAR(s.mean_plane_variance_m2, 0.01, 0.001);
  EXPECT_TRUE(std::isnan(self_consistency(PointGrid(std::span(points).first(3), 5.0), 5.0).mean_map_entropy));
}

TEST(PointGrid, FindsWhatASearchOfAllFinds) {
  const RandomStream random(17, "test.grid");
  std::vector<Eigen::Vector3f> points;
  for (std::uint64_t i = 0; i < 3000; ++i)
    points.emplace_back(random.uniform(-20, 20, 0, i), random.uniform(-20, 20, 1, i), random.uniform(-2, 2, 2, i));
  const PointGrid grid(points, 0.7);
  std::vector<std::uint32_t> found;
  for (std::uint64_t k = 0; k < 500; ++k) {
    const Eigen::Vector3d p(random.uniform(-22, 22, 3, k), random.uniform(-22, 22, 4, k), random.uniform(-3, 3, 5, k));
    double best = 3.0;
    std::vector<std::uint32_t> near;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const double d = (points[i].cast<double>() - p).norm();
      best = std::min(best, d);
      if (d <= 1.5) near.push_back(i);
    }
    EXPECT_NEAR(grid.nearest_m(p, 3.0), best, 1e-12);
    grid.within(p, 1.5, found);
    EXPECT_EQ(found, near);
  }
}

TEST(TruePoints, BeamsMeetGroundAndWall) {
  ScanDrive drive;
  drive.lidar = testing::ideal_lidar();
  drive.lidar.range_noise_m = 0.1;  // which true points do not have
  drive.scene = std::make_shared<const scene::Scene>(ground_and_wall());
  drive.motion = testing::standing(testing::pose_at(0, 0, 2, 0), 2.0);
  drive.start = testing::kStart;
  drive.scans = 3;
  const auto met = beams_met(drive, 1.0, 30.0);
  ASSERT_TRUE(met.ok());
  EXPECT_EQ(met->sensor_W.size(), 1U) << "it stands";
  ASSERT_GT(met->met_W.size(), 1000U);
  for (const Eigen::Vector3f& p : met->met_W) EXPECT_LT(std::min(std::abs(p.z()), std::abs(p.x() - 10.0F)), 1e-4F);
  // Surfaces near a map: as many as the area within 1 m has, 16 on a square metre: the map's 10 x 20 m and 1 m around.
  const auto map = sheet_and_wall(0.0F, 0.0F);
  std::vector<Eigen::Vector3f> ground;
  for (std::size_t i = 0; i < map.size(); i += 2) ground.push_back(map[i]);
  const auto near = surfaces_near(PointGrid(ground, 0.5), *drive.scene);
  const double area_m2 = 9.8 * 19.8 + 2 * 9.8 + 2 * 19.8 + kPi;
  EXPECT_NEAR(static_cast<double>(near.size()), 16.0 * area_m2, 4 * std::sqrt(16.0 * area_m2));
}

TEST(MapReport, SameBitsForAnyNumberOfThreads) {
  const scene::Scene scene(testing::street_crossing());
  const RandomStream random(19, "test.map");
  std::vector<Eigen::Vector3f> map;
  for (std::uint64_t i = 0; i < 20'000; ++i)
    map.emplace_back(random.uniform(-30, 30, 0, i), random.uniform(-30, 30, 1, i), random.uniform(-1, 9, 2, i));
  MapTruth truth;
  truth.points_W.assign(map.begin() + 5000, map.end());
  std::vector<MapReport> reports;
  for (const int n : {1, 2, 8}) {
    set_threads(n);
    reports.push_back(report_map(map, scene, truth, 5.0, 0.5));
  }
  set_threads(0);
  for (const MapReport& r : reports) {
    EXPECT_EQ(r.all.rms_m, reports[0].all.rms_m);
    EXPECT_EQ(r.all.signed_mean_m, reports[0].all.signed_mean_m);
    EXPECT_EQ(r.chamfer_m, reports[0].chamfer_m);
    EXPECT_EQ(r.consistency.mean_map_entropy, reports[0].consistency.mean_map_entropy);
    EXPECT_EQ(r.walls.p95_m, reports[0].walls.p95_m);
  }
}

TEST(MapReport, AnEmptyMapIsUndefined) {
  const scene::Scene scene(ground_and_wall());
  const MapReport none = report_map({}, scene, {}, 5.0, 0.5);
  EXPECT_EQ(none.points, 0);
  EXPECT_TRUE(std::isnan(none.all.rms_m) && std::isnan(none.p95_m) && std::isnan(none.accuracy[0]));
  EXPECT_TRUE(std::isnan(none.consistency.mean_map_entropy));
}

}  // namespace
}  // namespace canyon::lidar
