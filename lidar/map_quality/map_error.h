#pragma once

#include <cstdint>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/lidar/files/map_cloud.h"
#include "canyon/scene/scene_at.h"

namespace canyon::lidar {

/// How far a map lies from the true surfaces of the static scene.
struct MapQuality {
  std::int64_t points = 0;
  double map_error_rms_m = kNaN;  ///< distance to the nearest true surface
  double map_error_p95_m = kNaN;  ///< its 95th percentile (nearest rank)
  /// Height of a point above the nearest true surface point, over the points whose nearest surface is level ground or a
  /// roof (within 30 degrees of horizontal, no tree): the part of the error that walls cannot show, since a wall lifted
  /// by 2 m still lies on itself.
  double map_error_up_rms_m = kNaN;
  double map_error_up_mean_m = kNaN;  ///< the same, signed mean
  std::int64_t up_points = 0;
  std::int64_t capped_points = 0;  ///< no surface within the cap; they count with the cap
};

/// Distances beyond cap_m count as cap_m, so that the answer stays bounded and the search cheap.
inline constexpr double kMapErrorCap_m = 5.0;

struct MapScore {
  MapQuality quality;
  std::vector<float> error_m;  ///< of each point, its distance to the nearest true surface
};

/// Same bits for any number of threads. Values without points are NaN.
MapScore evaluate_map(const MapCloud& cloud, const scene::SceneAt& scene, double cap_m = kMapErrorCap_m);

}  // namespace canyon::lidar
