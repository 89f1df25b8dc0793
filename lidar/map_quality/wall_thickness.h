#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/messages.h"
#include "canyon/lidar/map_quality/signed_distance.h"

namespace canyon::lidar {

/// How thick walls have become in a map: a wall seen from two places with two errors stands there twice. Looked at are
/// patches of 2 x 2 m of steep surfaces (within 30 degrees of the vertical, of no tree) with at least 20 map points.
struct WallThickness {
  std::int64_t patches = 0;
  double median_m = kNaN, p95_m = kNaN;  ///< of the patches' thickness: 5th to 95th percentile of signed distances
  /// Share of patches whose distances fall into two layers at least 0.1 m apart, each with a tenth of the points: the
  /// two hold 85 % of the variance between them. Evenly spread distances hold 75 %, normal ones 64 % (Otsu 1979).
  double doubled_share = kNaN;
  double doubled_gap_median_m = kNaN;  ///< between the layers of those
};

/// A map point beside its nearest surface.
struct WallPoint {
  Eigen::Vector3f p_W;
  SurfaceOffset offset;
};
WallThickness wall_thickness(std::span<const WallPoint> points, const scene::Scene& scene);

}  // namespace canyon::lidar
