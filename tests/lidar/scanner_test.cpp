#include "canyon/lidar/scanner.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/core/process/parallel.h"
#include "canyon/lidar/beam/beam_table.h"
#include "canyon/tests/lidar/lidar_scenes.h"

namespace canyon::lidar {
namespace {

using testing::ideal_lidar;
using testing::kStart;
using testing::pose_at;
using testing::position;

std::unique_ptr<Scanner> scanner(const LidarConfig& config, std::uint64_t seed = 1) {
  auto made = make_scanner(config, seed);
  EXPECT_TRUE(made.ok()) << made.error().str();
  return *std::move(made);
}

LidarOutput scan_of(const scene::SceneParts& parts, const LidarConfig& config, const Trajectory& motion,
                    std::int64_t index = 0, std::uint64_t seed = 1) {
  const scene::Scene scene(parts);
  return scanner(config, seed)->scan(index, kStart, motion, scene::SceneAt(scene));
}

scene::SceneParts four_walls(double half_m) {
  scene::SceneParts parts = testing::empty_parts();
  testing::add_ground(parts, 2 * half_m, -1.0);
  const double h = half_m;
  testing::add_wall(parts, {h, -h}, {h, h}, 60);
  testing::add_wall(parts, {h, h}, {-h, h}, 60);
  testing::add_wall(parts, {-h, h}, {-h, -h}, 60);
  testing::add_wall(parts, {-h, -h}, {h, -h}, 60);
  return parts;
}

/// Where a beam's ray starts and points, from its ring and firing time alone: what a driver of the sensor would
/// compute.
struct NominalRay {
  Eigen::Vector3d origin, direction;
};
NominalRay nominal_ray(const LidarPoint& point, const BeamTable& table, const LidarConfig& config) {
  const Beam& beam = table.beams[point.ring];
  const double period_s = 1.0 / config.rate_hz;
  const double step_s = period_s / static_cast<double>(config.azimuth_steps);
  const double elapsed_s = point.time_s + period_s - step_s + table.last_firing_s();
  const double clockwise_from_behind = 2 * kPi * elapsed_s / period_s;
  const double yaw = kPi - clockwise_from_behind;
  return {{0, 0, beam.origin_up_m},
          {std::cos(beam.elevation_rad) * std::cos(yaw), std::cos(beam.elevation_rad) * std::sin(yaw),
           std::sin(beam.elevation_rad)}};
}

// Single-precision tracing in a local frame: 3 um median, 0.25 mm at 99.9 %; the product's promise is 0.1 mm within 100
// m.
constexpr double kRangeTolerance_m = 1e-4;
// time_s is a float: 0.1 s * 2^-24, times the head's 63 rad/s.
constexpr double kDirectionTolerance = 0.1 * 6e-8 * 2 * kPi / 0.1 + 1e-7;

TEST(SingleRay, RangesToPlanesFollowTheClosedForm) {
  const double half_m = 40;
  const Pose X_WB = pose_at(5, -7, 2, 33);
  LidarConfig config = ideal_lidar();
  config.mount_m = {0.3, -0.2, 1.8};
  config.mount_yaw_pitch_roll_deg = {20, 3, -2};
  const LidarOutput out = scan_of(four_walls(half_m), config, testing::standing(X_WB));
  const BeamTable table = *load_beam_table("vlp16");
  const Pose X_WL = X_WB * sensor_in_body(config);
  ASSERT_EQ(out.scan.points.size(), 28800u) << "walls all around";
  ASSERT_EQ(out.truth.size(), out.scan.points.size());
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    const LidarPoint& point = out.scan.points[i];
    const NominalRay ray = nominal_ray(point, table, config);
    const Eigen::Vector3d o = X_WL * ray.origin;
    const Eigen::Vector3d d = X_WL.R * ray.direction;
    double expected = d.z() < 0 ? (-1.0 - o.z()) / d.z() : 1e9;
    double cos_incidence = std::abs(d.z());
    for (int axis = 0; axis < 2; ++axis) {
      const double to_wall = (std::copysign(half_m, d[axis]) - o[axis]) / d[axis];
      if (to_wall < expected) cos_incidence = std::abs(d[axis]);
      expected = std::min(expected, to_wall);
    }
    ASSERT_NEAR(out.truth[i].range_m, expected, kRangeTolerance_m + expected * kDirectionTolerance * 10) << i;
    const Eigen::Vector3d p_L = position(point);
    ASSERT_LT((p_L - ray.origin - ray.direction * expected).norm(),
              2 * kRangeTolerance_m + expected * kDirectionTolerance * 10)
        << i;
    ASSERT_NEAR(out.truth[i].cos_incidence, cos_incidence, 2e-6);
  }
}

TEST(SingleRay, RangesToACylinderFollowTheClosedForm) {
  // 2048 facets around a radius of 10 m: they lie at most r (1 - cos(pi / n)) = 12 um inside the cylinder.
  constexpr int kFacets = 2048;
  constexpr double kRadius_m = 10.0;
  const Eigen::Vector2d center(18, 9);
  scene::SceneParts parts = testing::empty_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("tank", scene::ObjectKind::kBuilding);
  const auto corner = [&](int i, double z) {
    const double angle = 2 * kPi * i / kFacets;
    return Eigen::Vector3d(center.x() + kRadius_m * std::cos(angle), center.y() + kRadius_m * std::sin(angle), z);
  };
  for (int i = 0; i < kFacets; ++i)
    mesh.quad(corner(i, -50), corner(i + 1, -50), corner(i + 1, 50), corner(i, 50), mesh.material("metal"));

  const LidarConfig config = ideal_lidar();
  const LidarOutput out = scan_of(parts, config, testing::standing(Pose{}));
  const BeamTable table = *load_beam_table("vlp16");
  ASSERT_GT(out.scan.points.size(), 4000u);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    const NominalRay ray = nominal_ray(out.scan.points[i], table, config);
    const Eigen::Vector2d d = ray.direction.head<2>();
    const double b = d.dot(center);
    const double discriminant = b * b - d.squaredNorm() * (center.squaredNorm() - kRadius_m * kRadius_m);
    const double cos_incidence = std::sqrt(std::max(0.0, discriminant)) / kRadius_m;
    if (cos_incidence < 0.2) continue;  // a facet's 12 um become more along a grazing ray
    const double expected = (b - std::sqrt(discriminant)) / d.squaredNorm();
    ASSERT_NEAR(out.truth[i].range_m, expected, kRangeTolerance_m) << i;
    ++compared;
  }
  EXPECT_GT(compared, 3500u);
}

TEST(SingleRay, FiringTimesAreTheSensors) {
  const LidarConfig config = ideal_lidar();
  const LidarOutput out = scan_of(four_walls(20), config, testing::standing(Pose{}));
  ASSERT_EQ(out.scan.points.size(), 28800u);
  EXPECT_EQ(out.scan.period_s, 0.1);
  EXPECT_EQ(out.scan.points.back().time_s, 0.0f) << "the last firing is the stamp";
  for (std::size_t i = 0; i < out.scan.points.size(); ++i) {
    const std::size_t cycle = i / 16, laser = i % 16;
    const LidarPoint& point = out.scan.points[i];
    ASSERT_EQ(point.ring, laser) << "the VLP-16 fires in the order of its numbers";
    const double before_end_s =
        static_cast<double>(1799 - cycle) * (0.1 / 1800) + static_cast<double>(15 - laser) * 2.304e-6;
    ASSERT_NEAR(point.time_s, -before_end_s, 0.1 * 6e-8) << i;  // float
    ASSERT_GT(point.time_s, -0.1f) << "after the end of the scan before";
    if (i > 0) {
      ASSERT_GT(point.time_s, out.scan.points[i - 1].time_s);
    }
  }
}

TEST(SingleRay, SpinsClockwiseFromBehind) {
  const LidarOutput out = scan_of(four_walls(20), ideal_lidar(), testing::standing(Pose{}));
  const auto yaw_deg = [&](std::size_t cycle) {
    const LidarPoint& p = out.scan.points[cycle * 16];
    return std::atan2(p.y, p.x) / kDegree;
  };
  EXPECT_NEAR(std::abs(yaw_deg(0)), 180, 0.01);
  EXPECT_NEAR(yaw_deg(450), 90, 0.01) << "a quarter later it looks left";
  EXPECT_NEAR(yaw_deg(900), 0, 0.01);
  EXPECT_NEAR(yaw_deg(1350), -90, 0.01);
}

TEST(SingleRay, EveryRayLeavesFromWhereTheVehicleIsAtThatInstant) {
  // Straight at 20 m/s towards a wall at x = 60: the range along the ray shrinks by v t cos.
  Vector6d twist;
  twist << 0, 0, 0, 20, 0, 0;
  scene::SceneParts parts = testing::empty_parts();
  testing::add_wall(parts, {60, -300}, {60, 300}, 60);
  const LidarConfig config = ideal_lidar();
  const LidarOutput out = scan_of(parts, config, testing::twisting(Pose{}, twist));
  const BeamTable table = *load_beam_table("vlp16");
  ASSERT_GT(out.scan.points.size(), 4000u) << "the upper half of the beams, 53 deg to either side";
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    const LidarPoint& point = out.scan.points[i];
    const Eigen::Vector3d d = nominal_ray(point, table, config).direction;
    const double expected = (60.0 - 20.0 * point.time_s) / d.x();
    // Near the ends of the wall's span d.x is small and an error of direction counts 1 / cos^2.
    ASSERT_NEAR(out.truth[i].range_m, expected, kRangeTolerance_m + expected * kDirectionTolerance / d.x()) << i;
  }
}

TEST(SingleRay, NoiseHasTheStatedMomentsAndNothingElse) {
  LidarConfig config = ideal_lidar();
  config.range_noise_m = 0.02;
  const LidarOutput out = scan_of(four_walls(20), config, testing::standing(Pose{}), 7, 42);
  const double n = static_cast<double>(out.truth.size());
  ASSERT_EQ(n, 28800);
  const BeamTable table = *load_beam_table("vlp16");
  double sum = 0, squares = 0, lag = 0, previous = 0;
  std::size_t within = 0;
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    const LidarPoint& p = out.scan.points[i];
    const double measured_m = (position(p) - Eigen::Vector3d(0, 0, table.beams[p.ring].origin_up_m)).norm();
    const double error = (measured_m - out.truth[i].range_m) / config.range_noise_m;
    sum += error;
    squares += error * error;
    lag += error * previous;
    previous = error;
    within += std::abs(error) < 1.0;
  }
  // k = 4.5 sigma each: false alarms 7e-6 per line.
  EXPECT_NEAR(sum / n, 0, 4.5 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1, 4.5 * std::sqrt(2 / n));
  EXPECT_NEAR(lag / n, 0, 4.5 / std::sqrt(n)) << "beams of one cycle are independent";
  EXPECT_NEAR(static_cast<double>(within) / n, 0.682689, 4.5 * std::sqrt(0.6827 * 0.3173 / n)) << "Gaussian";
}

TEST(SingleRay, NoiseBelongsToLaserAndRevolution) {
  LidarConfig config = ideal_lidar();
  config.range_noise_m = 0.02;
  const auto parts = four_walls(20);
  const auto motion = testing::standing(Pose{});
  EXPECT_TRUE(testing::same(scan_of(parts, config, motion, 3), scan_of(parts, config, motion, 3)));
  EXPECT_FALSE(testing::same(scan_of(parts, config, motion, 3), scan_of(parts, config, motion, 4)));
  EXPECT_FALSE(testing::same(scan_of(parts, config, motion, 3, 1), scan_of(parts, config, motion, 3, 2)));
}

TEST(SingleRay, RangesComeInStepsAndWithinTheLimits) {
  LidarConfig config = ideal_lidar();
  config.range_noise_m = 0.02;
  config.report.range_quantum_m = 0.002;
  config.report.min_range_m = 20.5;
  config.report.max_range_m = 25.0;
  const LidarOutput out = scan_of(four_walls(20), config, testing::standing(Pose{}));
  ASSERT_GT(out.scan.points.size(), 1000u);
  ASSERT_LT(out.scan.points.size(), 28800u);
  const BeamTable table = *load_beam_table("vlp16");
  bool beyond = false;
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    const LidarPoint& p = out.scan.points[i];
    const double measured_m = (position(p) - Eigen::Vector3d(0, 0, table.beams[p.ring].origin_up_m)).norm();
    // Rounding of three float coordinates of 25 m, and of a direction in floats: its length is 1 to four roundings.
    constexpr double kRounding_m = 25 * 6 * 6e-8;
    EXPECT_NEAR(std::remainder(measured_m, 0.002), 0, kRounding_m);
    EXPECT_GE(measured_m, 20.5 - kRounding_m);
    EXPECT_LE(measured_m, 25.0 + kRounding_m);
    beyond |= out.truth[i].range_m > 25.0f;
  }
  EXPECT_TRUE(beyond) << "a surface just beyond the limit may measure within it";
}

TEST(SingleRay, IntensityIsReflectivityTimesCosine) {
  const auto parts = four_walls(20);
  const LidarOutput out = scan_of(parts, ideal_lidar(), testing::standing(Pose{}));
  std::set<std::uint16_t> materials;
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    const auto& material = parts.materials[out.truth[i].material];
    materials.insert(out.truth[i].material);
    ASSERT_EQ(parts.objects[out.truth[i].object].kind == scene::ObjectKind::kTerrain, material.name == "asphalt");
    ASSERT_FLOAT_EQ(out.scan.points[i].intensity,
                    static_cast<float>(material.lidar_reflectance) * out.truth[i].cos_incidence);
  }
  EXPECT_EQ(materials.size(), 2u);
}

TEST(SingleRay, WhereNothingIsNothingReturns) {
  const LidarOutput empty = scan_of(testing::empty_parts(), ideal_lidar(), testing::standing(Pose{}));
  EXPECT_TRUE(empty.scan.points.empty());
  EXPECT_TRUE(empty.truth.empty());
}

TEST(SingleRay, BlindedReturnsNothing) {
  LidarConfig config;
  config.blinded = true;
  const scene::Scene scene(four_walls(20));
  const auto blind = scanner(config);
  const LidarOutput out = blind->scan(0, kStart, testing::standing(Pose{}), scene::SceneAt(scene));
  EXPECT_TRUE(out.scan.points.empty());
  EXPECT_TRUE(out.truth.empty());
  EXPECT_EQ(out.scan.t, kStart);
  EXPECT_EQ(out.scan.period_s, 0.1);
  EXPECT_EQ(blind->rays(), 0);
  const auto seeing = scanner(LidarConfig{});
  seeing->scan(0, kStart, testing::standing(Pose{}), scene::SceneAt(scene));
  seeing->scan(1, kStart, testing::standing(Pose{}), scene::SceneAt(scene));
  EXPECT_EQ(seeing->rays(), 2 * 28800);
}

TEST(SingleRay, SameBitsForAnyNumberOfThreads) {
  Vector6d twist;
  twist << 0, 0, 0.5, 8, 0, 0;
  const scene::Scene scene(testing::street_crossing());
  const Trajectory motion = testing::twisting(pose_at(-10, 1, 0, 10), twist);
  std::vector<LidarOutput> outputs;
  for (const int n : {1, 2, 8}) {
    set_threads(n);
    outputs.push_back(scanner(LidarConfig{})->scan(5, kStart, motion, scene::SceneAt(scene)));
  }
  set_threads(0);
  EXPECT_GT(outputs[0].scan.points.size(), 10000u);
  EXPECT_TRUE(testing::same(outputs[0], outputs[1]));
  EXPECT_TRUE(testing::same(outputs[0], outputs[2]));
}

TEST(SingleRay, MotionThatDoesNotCoverTheSweepIsAProgrammersMistake) {
  Trajectory late;
  late.append({kStart - 0.05, Pose{}});
  late.append({kStart, Pose{}});
  EXPECT_THROW(scan_of(four_walls(20), ideal_lidar(), late), ProgramError);
  EXPECT_THROW(scan_of(four_walls(20), ideal_lidar(), testing::standing(Pose{}), -1), ProgramError);
}

TEST(LidarConfig, MistakesAreNamed) {
  const auto error_of = [](auto change) {
    LidarConfig config;
    change(config);
    const auto made = make_scanner(config, 1);
    return made.ok() ? std::string("no error") : made.error().str();
  };
  EXPECT_EQ(
      error_of([](LidarConfig& c) { c.rate_hz = 20; }),
      "lidar.azimuth_steps, lidar.rate_hz: 1800 firings a revolution at 20 Hz, expected lidar.azimuth_steps of at "
      "most 904 at lidar.rate_hz = 20 (vlp16 needs 55.296 us per firing)");
  EXPECT_EQ(error_of([](LidarConfig& c) { c.rate_hz = 20, c.azimuth_steps = 904; }), "no error");
  EXPECT_EQ(error_of([](LidarConfig& c) { c.beams = "grid16", c.rate_hz = 20; }), "no error") << "no cycle, no limit";
  EXPECT_EQ(error_of([](LidarConfig& c) { c.beams = "mid360"; }),
            "lidar.azimuth_steps: 1800, expected 0 (mid360 has a path of its own, at its own rate)");
  EXPECT_EQ(error_of([](LidarConfig& c) {
              c.ego.min_m = {-1, -1, 0}, c.ego.max_m = {3, 1, 2};
            }),
            "lidar.ego_min_m, lidar.ego_max_m, lidar.mount_m: the sensor itself is in the box that hides its own "
            "vehicle, expected a box from lidar.ego_min_m to lidar.ego_max_m that leaves out lidar.mount_m");
  EXPECT_EQ(error_of([](LidarConfig& c) {
              c.ego.min_m = {-1, -1, 0}, c.ego.max_m = {3, -2, 2};
            }),
            "lidar.ego_min_m, lidar.ego_max_m: the highest corner lies lower than the lowest, expected "
            "lidar.ego_max_m of lidar.ego_min_m or more along each axis");
  EXPECT_EQ(error_of([](LidarConfig& c) { c.report.min_range_m = 100; }),
            "lidar.min_range_m, lidar.max_range_m: ranges from 100 to 100 m, expected lidar.min_range_m below "
            "lidar.max_range_m");
  EXPECT_EQ(error_of([](LidarConfig& c) { c.model.name = "two_ray"; }),
            "lidar.model: unknown name \"two_ray\", expected one of \"single_ray\", \"footprint\"");
  EXPECT_EQ(error_of([](LidarConfig& c) { c.beams = "os1"; }),
            "lidar.beams: unknown beam table \"os1\" (did you mean \"os1_64\"?), expected one of grid16, hdl32e, "
            "hdl64e, mid360, "
            "os1_128, os1_64, vlp16, grid:LASERS:MIN_DEG:MAX_DEG, or the path of a .csv file");
}

TEST(LidarConfig, EveryFieldIsReadFromTheMissionFile) {
  const auto root = ConfigNode::parse(
      "beams = \"grid16\"\nmodel = \"single_ray\"\nrate_hz = 5\nazimuth_steps = 900\nmount_m = [1, 2, 3]\n"
      "mount_yaw_pitch_roll_deg = [90, 0, 0]\nmin_range_m = 0.5\nmax_range_m = 50\nrange_noise_m = 0.01\n"
      "range_quantum_m = 0.004\nblinded = true\n",
      "m.toml");
  ASSERT_TRUE(root.ok()) << root.error().str();
  LidarConfig c;
  const Status status = read_config(&*root, "lidar", c);
  ASSERT_TRUE(status.ok()) << status.error().str();
  EXPECT_EQ(c.beams, "grid16");
  EXPECT_EQ(c.rate_hz, 5);
  EXPECT_EQ(c.azimuth_steps, 900);
  EXPECT_EQ(c.report.min_range_m, 0.5);
  EXPECT_EQ(c.report.max_range_m, 50);
  EXPECT_EQ(c.range_noise_m, 0.01);
  EXPECT_EQ(c.report.range_quantum_m, 0.004);
  EXPECT_TRUE(c.blinded);
  // A point ahead of the sensor, which looks left, lies to the left of the body.
  EXPECT_LT((sensor_in_body(c) * Eigen::Vector3d(10, 0, 0) - Eigen::Vector3d(1, 12, 3)).norm(), 1e-12);
}

/// The quick way to ranges alone gives the very numbers of the scan's truth: driving in a curve, sweeps that fill no
/// whole packets, a head and a rosette, shaken and hidden beams.
TEST(TrueRanges, AreThoseOfTheScansTruth) {
  const scene::Scene scene(four_walls(20));
  const scene::SceneAt at(scene);
  Vector6d twist;
  twist << 0.02, -0.01, 0.3, 8, 0.1, 0;
  Trajectory motion;
  for (int k = -40; k <= 2; ++k) motion.append({kStart + 0.005 * k, Pose::exp(twist * (0.005 * k))});
  const auto expect_same = [&](const LidarConfig& config, std::size_t least) {
    std::vector<float> quick = scanner(config)->true_ranges(3, kStart, motion, at), slow;
    for (const LidarPointTruth& t : scanner(config)->scan(3, kStart, motion, at).truth) slow.push_back(t.range_m);
    std::erase_if(quick, [](float range_m) { return std::isinf(range_m); });
    std::sort(quick.begin(), quick.end());
    std::sort(slow.begin(), slow.end());
    EXPECT_GT(slow.size(), least);
    EXPECT_EQ(quick, slow);
  };
  for (const char* beams : {"vlp16", "os1_64", "mid360"}) {
    SCOPED_TRACE(beams);
    LidarConfig config = ideal_lidar();
    config.beams = beams;
    config.azimuth_steps = std::string(beams) == "mid360" ? 0 : 1003;
    expect_same(config, 10000);
    config.angle_noise_deg = 0.05;
    expect_same(config, 10000);
    config.angle_noise_deg = 0;
    config.ego.min_m = {0.5, -30, -30}, config.ego.max_m = {30, 30, 30};  // what lies ahead
    expect_same(config, 5000);
  }
}

}  // namespace
}  // namespace canyon::lidar
