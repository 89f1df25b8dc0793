// Things that move while the sensor turns.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/process/parallel.h"
#include "canyon/scene/tracing/instances.h"
#include "canyon/tests/lidar/lidar_scenes.h"

namespace canyon::lidar {
namespace {

using testing::kStart;

constexpr double kSpeed_m_s = 20.0;

/// A box of 4 x 2 x 2 m on the ground, x forward.
std::shared_ptr<const scene::RigidShape> box_shape() {
  scene::SceneParts parts = testing::empty_parts();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("box", scene::ObjectKind::kVehicle);
  mesh.box({0, 0, 1}, Eigen::Matrix3d::Identity(), {2, 1, 1}, mesh.material("painted_metal"));
  return std::make_shared<const scene::RigidShape>("box", scene::ObjectKind::kVehicle, parts.mesh);
}

/// It drives along y at x = 12, in the middle of the sensor's view at the stamp less half a turn.
Pose place_at(double after_stamp_s) {
  return {rotation_from({.yaw_rad = kPi / 2}), {12.0, kSpeed_m_s * (after_stamp_s + 0.05), 0.0}};
}

LidarOutput scan_of_traffic(bool seen_moving) {
  static const auto shape = box_shape();
  const scene::Scene scene(testing::empty_parts());
  scene::SceneAt at(scene);
  at.set_instances({{shape, "box", place_at(0)}});
  LidarConfig config = testing::ideal_lidar();
  config.beams = "grid:8:-4:4";
  config.azimuth_steps = 18000;
  const auto scanner = *make_scanner(config, 1);
  LidarOutput out;
  Scanner::InstancesAt moving;
  if (seen_moving)
    moving = [](double after_s) { return std::vector<scene::Instance>{{shape, "box", place_at(after_s)}}; };
  scanner->scan(0, kStart, testing::standing({Eigen::Quaterniond::Identity(), {0, 0, 1}}), at, moving, out);
  return out;
}

/// Every point lies on the box where it was when the laser fired: things are placed anew for every 32 cycles, so they
/// are off by half of 32 * 0.1 s / 1800 at most.
TEST(MovingThings, PointsLieOnTheCarAtTheirOwnFiringTime) {
  const LidarOutput out = scan_of_traffic(true);
  ASSERT_GT(out.scan.points.size(), 300u);
  constexpr double kLag_m = kSpeed_m_s * 16.0 * 0.1 / 18000.0 + 1e-3;
  double first_s = 0, last_s = -1;
  for (std::size_t i = 0; i < out.scan.points.size(); ++i) {
    const LidarPoint& p = out.scan.points[i];
    const Eigen::Vector3d in_S = place_at(p.time_s).inverse() * (Eigen::Vector3d(0, 0, 1) + testing::position(p));
    const Eigen::Vector3d off = (in_S - Eigen::Vector3d(0, 0, 1)).cwiseAbs() - Eigen::Vector3d(2, 1, 1);
    EXPECT_LE(off.maxCoeff(), kLag_m) << i;
    EXPECT_GE(off.maxCoeff(), -kLag_m) << i << ": on a face";
    EXPECT_EQ(out.truth[i].object, 0u);
    first_s = std::min(first_s, double{p.time_s}), last_s = std::max(last_s, double{p.time_s});
  }
  EXPECT_LT(first_s, last_s);
}

/// The near side, 4 m long at 11 m, driving to the left at v, seen by a head that turns to the right (clockwise) at w:
/// its ends at angle phi = atan(y / 11) are met at times t with y(t) = 11 tan(phi(t)). To first order in v / (11 w) the
/// length looks shorter by v times the time the head takes from end to end, dt = 2 atan(2 / 11) / w.
TEST(MovingThings, TheirLengthIsSkewedByTheirWayDuringTheSweep) {
  const auto length_m = [](const LidarOutput& out) {
    double low = 1e9, high = -1e9;
    for (const LidarPoint& p : out.scan.points) {
      if (std::abs(p.x - 11.0) > 0.02) continue;  // the near side
      low = std::min(low, double{p.y}), high = std::max(high, double{p.y});
    }
    return high - low;
  };
  const double w_rad_s = 2 * kPi / 0.1, step_m = 11 * w_rad_s * 0.1 / 18000;
  const double still_m = length_m(scan_of_traffic(false)), moving_m = length_m(scan_of_traffic(true));
  EXPECT_NEAR(still_m, 4.0, 2.2 * step_m) << "to a step of the azimuth at either end";
  // Exactly: the left end is met at t1 and the right end later at t2, with angles that the head gives.
  double t1 = 0, t2 = 0;  // after the instant at which the head looks along x and the box is in the middle
  for (int k = 0; k < 50; ++k) {
    t1 = -std::atan((2.0 + kSpeed_m_s * t1) / 11.0) / w_rad_s;
    t2 = -std::atan((-2.0 + kSpeed_m_s * t2) / 11.0) / w_rad_s;
  }
  const double expected_m = (2.0 + kSpeed_m_s * t1) - (-2.0 + kSpeed_m_s * t2);
  EXPECT_NEAR(expected_m, 4.0 - kSpeed_m_s * 2 * std::atan(2.0 / 11.0) / w_rad_s, 0.02);
  EXPECT_NEAR(moving_m, expected_m, 2.2 * step_m + 2 * kSpeed_m_s * 16.0 * 0.1 / 18000.0);
  EXPECT_LT(moving_m, still_m - 0.05) << "the skew is seen";
}

TEST(MovingThings, SameBitsForAnyNumberOfThreads) {
  std::vector<LidarOutput> outputs;
  for (const int n : {1, 2, 8}) {
    set_threads(n);
    outputs.push_back(scan_of_traffic(true));
  }
  set_threads(0);
  EXPECT_TRUE(testing::same(outputs[0], outputs[1]));
  EXPECT_TRUE(testing::same(outputs[0], outputs[2]));
}

}  // namespace
}  // namespace canyon::lidar
