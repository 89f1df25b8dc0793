#include "canyon/lidar/scan_drive.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"

namespace canyon::lidar {

void ScanDrive::cover_motion() {
  CANYON_CHECK(!motion.empty(), "no poses");
  const auto& poses = motion.poses();
  start = poses.front().t + before_s();
  const double periods = std::floor((poses.back().t - start) / period_s() + 1e-9);
  scans = static_cast<std::int64_t>(std::max(0.0, periods + 1.0));
}

namespace {

/// Rounding of times may cost the motion's ends a few ns.
constexpr double kTimeRounding_s = 1e-6;

void check_coverage(const ScanDrive& drive) {
  if (drive.scans < 1) return;
  const GpsTime from = drive.start - drive.before_s();
  const GpsTime to = drive.start + static_cast<double>(drive.scans - 1) * drive.period_s();
  CANYON_CHECK(!drive.motion.empty(), "no poses for ", drive.scans, " scans");
  const auto& poses = drive.motion.poses();
  CANYON_CHECK(poses.front().t - from <= kTimeRounding_s && to - poses.back().t <= kTimeRounding_s, "motion from ",
               poses.front().t.iso(), " to ", poses.back().t.iso(), ", scans from ", from.iso(), " to ", to.iso());
}

}  // namespace

Result<ScanDriveCost> scan_drive(const ScanDrive& drive, std::uint64_t seed, const TakeScan& take) {
  CANYON_TRY(const auto scanner, make_scanner(drive.lidar, seed));
  check_coverage(drive);
  scene::SceneAt scene(*drive.scene);
  ScanDriveCost cost;
  LidarOutput output;
  for (std::int64_t k = 0; k < drive.scans; ++k) {
    throw_if_cancelled();
    const GpsTime t = drive.start + static_cast<double>(k) / drive.lidar.rate_hz;
    const double traffic_s = t - drive.traffic_start;
    Scanner::InstancesAt moving;
    if (!drive.traffic.empty()) {
      scene.set_instances(drive.traffic.at(traffic_s));
      moving = [&](double after_s) { return drive.traffic.at(traffic_s + after_s); };
    }
    const auto begin = std::chrono::steady_clock::now();
    scanner->scan(k, t, drive.motion, scene, moving, output);
    cost.scanning_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    cost.points += static_cast<std::int64_t>(output.scan.points.size());
    CANYON_TRY_STATUS(take(k, t, output, scene));
  }
  cost.rays = scanner->rays();
  return cost;
}

std::vector<LidarPoint> points_in_scene(const ScanDrive& drive, const LidarScan& scan) {
  const Pose X_BL = sensor_in_body(drive.lidar);
  std::vector<LidarPoint> points = scan.points;
  for (LidarPoint& p : points) {
    const auto X_WB = drive.motion.at(scan.t - drive.lidar.latency_s + double{p.time_s});
    const Eigen::Vector3d p_W = *X_WB * X_BL * Eigen::Vector3d(p.x, p.y, p.z);
    p.x = static_cast<float>(p_W.x()), p.y = static_cast<float>(p_W.y()), p.z = static_cast<float>(p_W.z());
  }
  return points;
}

}  // namespace canyon::lidar
