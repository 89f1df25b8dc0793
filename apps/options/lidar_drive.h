#pragma once

#include <optional>
#include <string>

#include "canyon/apps/options/scene_options.h"
#include "canyon/lidar/scan_drive.h"

namespace canyon::apps {

/// Options that say which LIDAR scans what from where, for the verbs that scan by themselves.
struct LidarDriveOptions {
  SceneOptions scene;
  std::string fidelity = "high";
  std::string at, trajectory, beams, model, detector, returns, see_through, start;
  std::optional<double> rate_hz;
  std::optional<std::int64_t> azimuth_steps;
  std::int64_t scans = 1;
};
void declare_lidar_drive(Arguments& arguments, LidarDriveOptions& options);
/// Of these the scene, and along --trajectory alone, which may be left away, the LIDAR: its options are refused without
/// a way. Returns --trajectory, for more that needs it.
Argument declare_lidar_way(Arguments& arguments, LidarDriveOptions& options);

Result<lidar::ScanDrive> lidar_drive(const LidarDriveOptions& options);

}  // namespace canyon::apps
