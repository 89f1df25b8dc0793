#pragma once

#include <memory>

#include "canyon/mission/autonomy/autonomy.h"

namespace canyon::mission {

/// The reference autonomy: keeps a local height grid of what it sees, chooses among paths shifted sideways from the
/// street's centre line the cheapest that is free, follows it by pure pursuit (Coulter 1992), slows for corners,
/// obstacles and waypoints, and decides from its estimate that a waypoint is reached.
std::unique_ptr<Autonomy> make_reference_autonomy(const AutonomyConfig& config, const PriorKnowledge& prior,
                                                  GpsTime start);

}  // namespace canyon::mission
