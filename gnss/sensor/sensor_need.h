#pragma once

#include <vector>

#include "canyon/core/motion/route_segment.h"
#include "canyon/core/need.h"
#include "canyon/gnss/paths/need/obstacle_heights.h"
#include "canyon/gnss/paths/need/sky_span.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/sensor/gnss_config.h"

namespace canyon::gnss {

/// Where a sensor is asked what it needs: what all pieces of a route share.
struct GnssSurroundings {
  const scene::Scene& scene;
  SkySpan sky;
  ObstacleHeights heights;
  GpsTime start;
  double low_m = 0.0;  ///< lowest place of the route, in W

  /// For a vehicle that stays within `route` from start to end. Errors as make_satellite_source.
  static Result<GnssSurroundings> make(const GnssConfig& config, const scene::Scene& scene,
                                       const std::vector<scene::SweptRoom>& moving, GpsTime start, GpsTime end,
                                       const std::vector<RouteSegment>& route);
};

/// What the configured sensor says of its effects on a piece of the route; empty: it has none that depend on places.
std::vector<Need> gnss_needs(const GnssConfig& config, const GnssSurroundings& around, const RouteSegment& segment);

/// What it says of the delays of its ranges: how far leaving one out moves a range at most, along the whole route.
std::vector<Need> gnss_range_needs(const GnssConfig& config, const GnssSurroundings& around);

/// Those that are not needed.
DelayOmissions delays_of(const std::vector<Need>& needs);

/// What may be left out where these needs hold.
PathOmissions omissions_of(const std::vector<Need>& needs);

/// What the receiver can notice of weak fields; the rest at its defaults.
PathParameters path_limits(const GnssConfig& config);

}  // namespace canyon::gnss
