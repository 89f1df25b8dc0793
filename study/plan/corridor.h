#pragma once

#include <vector>

#include "canyon/core/motion/route_segment.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::study {

/// Length of the pieces of a corridor: short ones say more, and cost more to ask.
inline constexpr double kPiece_m = 10.0;

/// The planned route in pieces, with the room within `half_width_m` beside it and the heights that a body on that
/// ground has: 0.5 m more to both sides, for road roughness, suspension and what lies between the points that are
/// looked at. A piece without ground under it holds no place.
std::vector<RouteSegment> corridor_of(const mission::PreparedMission& mission, double half_width_m);

}  // namespace canyon::study
