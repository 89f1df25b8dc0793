#pragma once

#include <functional>

#include "canyon/core/motion/trajectory.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/lidar/scanner.h"
#include "canyon/scene/city/traffic.h"

namespace canyon::lidar {

/// What to scan with, where, and along which way: without vehicle, filter and mission.
struct ScanDrive {
  LidarConfig lidar;
  std::shared_ptr<const scene::Scene> scene;
  scene::Traffic traffic;
  GpsTime traffic_start;
  GpsTime start;      ///< stamp of the first scan
  Trajectory motion;  ///< of the vehicle, from before the first scan to the last
  std::int64_t scans = 1;

  double period_s() const { return 1.0 / lidar.rate_hz; }
  /// How long before its stamp the first laser of a scan may fire: lasers that run free begin a scan up to one cycle,
  /// below 1 ms, before its period.
  double before_s() const { return period_s() + lidar.latency_s + 1e-3; }
  /// Along the whole of `motion`, which must not be empty: the first stamp and as many scans as it covers; 0 if it is
  /// too short for one.
  void cover_motion();
};

/// What it took to scan, without what the scans were taken for.
struct ScanDriveCost {
  std::int64_t rays = 0, points = 0;
  double scanning_s = 0.0;  ///< wall time
};
/// What takes a scan: its number from 0, its stamp, the scan with its truth, and the scene as it was at the stamp. An
/// Error ends the drive.
using TakeScan = std::function<Status(std::int64_t, GpsTime, const LidarOutput&, const scene::SceneAt&)>;
/// All scans, one after the other in order of time. `motion` must cover them, from before_s() before the first stamp to
/// the last one. Errors: a configuration that no scanner can be made of, and what `take` refuses, as it says it.
Result<ScanDriveCost> scan_drive(const ScanDrive& drive, std::uint64_t seed, const TakeScan& take);

/// The points of a scan in W, each from where the sensor truly was when it fired.
std::vector<LidarPoint> points_in_scene(const ScanDrive& drive, const LidarScan& scan);

}  // namespace canyon::lidar
