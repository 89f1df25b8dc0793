#pragma once

#include <vector>

#include <Eigen/Core>

#include "canyon/core/result.h"
#include "canyon/lidar/map_quality/point_grid.h"
#include "canyon/lidar/scan_drive.h"

namespace canyon::lidar {

/// What a map of a drive ought to hold, in W.
struct TruePoints {
  std::vector<Eigen::Vector3f> met_W;     ///< what faultless thin beams met, one point per cube of kTruePointLeaf_m
  std::vector<Eigen::Vector3f> sensor_W;  ///< from where, a place for each scan
};
inline constexpr double kTruePointLeaf_m = 0.1;

/// Fires the drive's beams from its true motion, one scan every `step_m` of its way, and takes what lies within
/// reach_m; moving things are not there.
Result<TruePoints> beams_met(const ScanDrive& drive, double step_m, double reach_m);

/// Where nothing is known of the drive: random points, 16 in a square metre, of all static surfaces within 1 m of a
/// map point. What the map misses by more than that does not count, so this says less than beams do.
std::vector<Eigen::Vector3f> surfaces_near(const PointGrid& map, const scene::Scene& scene);

}  // namespace canyon::lidar
