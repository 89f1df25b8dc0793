#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/messages.h"
#include "canyon/lidar/map_quality/self_consistency.h"
#include "canyon/lidar/map_quality/wall_thickness.h"
#include "canyon/scene/scene.h"

namespace canyon::lidar {

/// Distances within which a point counts as right, m.
inline constexpr std::array<double, 3> kWithin_m{0.05, 0.10, 0.20};

/// What a map is compared with.
struct MapTruth {
  /// Points of true surfaces that a complete map holds, in W (true_points.h); empty: completeness is not known.
  std::vector<Eigen::Vector3f> points_W;
  /// Places of the sensor; a map point's range is that to the nearest. Empty: no split by range.
  std::vector<Eigen::Vector3f> sensor_W;
};

/// Errors of some of a map's points to the nearest true surface; NaN without points.
struct MapErrors {
  std::string name;  ///< of the part: a material, or a span of ranges
  std::int64_t points = 0;
  double rms_m = kNaN, up_rms_m = kNaN, across_rms_m = kNaN;
  double signed_mean_m = kNaN;  ///< positive: in front of the surfaces
};

/// A map against the true surfaces of a static scene. Up and across are the vertical and the horizontal part of the
/// way from the nearest surface point: rms^2 = up^2 + across^2. Points without a surface within the cap count with it
/// in rms_m and p95_m, and in nothing else.
struct MapReport {
  std::int64_t points = 0, capped_points = 0;
  MapErrors all;
  double level_up_rms_m = kNaN;  ///< over level ground and roofs alone, as a run's map_error_up_rms_m
  double p95_m = kNaN;
  std::vector<MapErrors> by_material, by_range;

  std::array<double, 3> accuracy{kNaN, kNaN, kNaN};      ///< share of map points within kWithin_m of a surface
  std::array<double, 3> completeness{kNaN, kNaN, kNaN};  ///< share of true points within kWithin_m of a map point
  std::array<double, 3> f_score{kNaN, kNaN, kNaN};       ///< harmonic mean of the two (Knapitsch et al. 2017)
  /// Mean distance map to surface plus mean distance true point to map, each capped.
  double chamfer_m = kNaN;
  std::int64_t true_points = 0;

  WallThickness walls;
  SelfConsistency consistency;  ///< needs no truth
};

/// Points of the map must be finite; cap_m > 0. Same bits for any number of threads.
MapReport report_map(std::span<const Eigen::Vector3f> map_W, const scene::Scene& scene, const MapTruth& truth,
                     double cap_m, double neighbourhood_m);

}  // namespace canyon::lidar
