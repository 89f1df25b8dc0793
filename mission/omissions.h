#pragma once

#include <limits>
#include <string>
#include <vector>

#include "canyon/core/motion/route_segment.h"
#include "canyon/fusion/strapdown/strapdown_omissions.h"
#include "canyon/gnss/paths/path_omissions.h"
#include "canyon/gnss/receiver/modes/delay_omissions.h"
#include "canyon/lidar/clearance.h"
#include "canyon/mission/config/mission_config.h"

namespace canyon::mission {

/// A piece of the planned corridor, and what cannot act on a vehicle in it.
struct PlannedPlace {
  RouteSegment segment;
  gnss::PathOmissions paths;
  lidar::Clearance around;
};

/// What a run leaves out (study/plan decides it): nothing, unless it is told otherwise.
struct Omissions {
  // Because nobody reads it.
  bool registration = false;   ///< keyframes are not aligned; only where no one works with registered poses
  bool maps = false;           ///< no cells are kept, and nothing is scored
  bool map_by_filter = false;  ///< the same of the map by the filter's pose alone; no plan asks for it
  bool keyframes = false;      ///< none are chosen; nothing may be made of them
  bool autonomy = false;       ///< it is neither shown nor asked anything; only on a tape
  bool unkept_rays = false;    ///< those whose returns the autonomy would drop; only where it alone takes scans

  // Because it acts by less than is asked for.
  fusion::StrapdownOmissions strapdown;  ///< of the filter's integrator

  // Because it cannot act there.
  std::vector<PlannedPlace> corridor;                                 ///< empty: nothing is known of places
  double corridor_until_s = std::numeric_limits<double>::infinity();  ///< after the start; the sky moves on

  // Because it acts by less than is asked for, or cancels.
  gnss::RangeOmissions ranges;

  /// Whether any of it moves an estimate.
  bool moves() const { return ranges.bound_m > 0.0 || strapdown.any(); }
  bool any() const {
    return registration || maps || map_by_filter || keyframes || autonomy || unkept_rays || !corridor.empty() ||
           ranges.any() || strapdown.any();
  }
};

/// False where something that is not left out works with what is.
bool can_leave_out(const MissionConfig& config, const Omissions& omissions);
/// The configuration of a run that leaves these out: what the configuration itself can switch off. They must be
/// such as can_leave_out().
MissionConfig without(MissionConfig config, const Omissions& omissions);

}  // namespace canyon::mission
