#pragma once

#include <cstdint>

#include "canyon/core/messages.h"
#include "canyon/lidar/map_quality/point_grid.h"

namespace canyon::lidar {

/// How crisp a map is by itself, without truth: of each point the scatter S of its neighbours within a radius.
struct SelfConsistency {
  /// Mean of ln(det(2 pi e S)) / 2, in nats with lengths in metres (Droeschel & Behnke, ICRA 2018, eq. 15); lower is
  /// crisper. Variances below (1 mm)^2 count as that, so that points in a plane do not make it -infinity.
  double mean_map_entropy = kNaN;
  double mean_plane_variance_m2 = kNaN;  ///< mean of S's smallest eigenvalue (Razlaw et al., ECMR 2015)
  std::int64_t points = 0;               ///< that have kFewestNeighbours, themselves included; others are left out
};
inline constexpr std::size_t kFewestNeighbours = 5;

/// 0 < radius_m <= the map's cells. Same bits for any number of threads.
SelfConsistency self_consistency(const PointGrid& map, double radius_m);

}  // namespace canyon::lidar
