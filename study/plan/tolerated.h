#pragma once

#include <string>
#include <vector>

#include "canyon/core/need.h"
#include "canyon/study/plan/plan.h"
#include "canyon/study/plan/replay/position_chain.h"

namespace canyon::study {

/// That every tolerance is of a figure that a bound reaches; an Error, for `option`, names the one that is not.
Status check_reached(const FigureValues& tolerances, const std::string& option);

/// What acts by less than is asked for (bounds above 0, of a range; and of the filter's integrator, of the attitude):
/// adds the needs to the plan's lines, and leaves out those that save most work per bound first, as long as the sum of
/// the bounds, carried to the figures along the mission's own route (study/plan/replay/position_chain.h), stays within
/// every tolerance. A bound of 0 is left out in any case, the others never without a tolerance, nor in a closed loop,
/// where a moved estimate moves the vehicle, nor beside an output that a moved estimate moves by nobody knows how much.
/// Errors as of drive_route and run_mission.
Status leave_out_tolerated(const std::vector<Need>& needs, const mission::MissionConfig& config,
                           const mission::PreparedMission& mission, bool open_loop, Plan& plan);

/// The choice alone, of candidates whose saved work is known: those that are kept get their verdict and reason, the
/// others stand in the plan's omissions and bounds. All come back in the order in which they were tried.
void choose_within_tolerances(const PositionChain& chain, std::vector<PlannedEffect>& candidates, Plan& plan);

}  // namespace canyon::study
