#pragma once

#include <vector>

#include "canyon/core/result.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/study/compare.h"
#include "canyon/study/reproduce/reproduction.h"

/// What the paper draws of its mission, of ours.
namespace canyon::study {

/// Figure 8: the scene from above with its buildings' outlines, the waypoints by name, those apart at which the vehicle
/// stops and looks, and the route that is planned past them.
std::vector<PaperCurve> scene_curves(const mission::MissionConfig& config, const mission::PreparedMission& mission);

/// Figures 9 and 10: true and estimated positions of each run, one a second, and the fixes of all but the first, whose
/// lie on its path; from above, then their heights in W over time. Drives the open loop `open`, which has a tape, once
/// more with its own seed.
Result<std::vector<PaperCurve>> track_curves(const Comparison& open);

}  // namespace canyon::study
