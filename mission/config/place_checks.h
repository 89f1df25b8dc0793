#pragma once

#include "canyon/core/result.h"
#include "canyon/mission/autonomy/autonomy.h"
#include "canyon/mission/config/mission_config.h"
#include "canyon/scene/city/site.h"

namespace canyon::mission {

struct PreparedMission;

/// What a mission asks of places, checked before it is driven, each as soon as what it needs is there. Errors name the
/// keys; MissionFile::locate adds file and line.

/// Start and waypoints lie on the site and outside buildings, observed buildings exist (in an empty city none does and
/// none is asked for), every waypoint lies within success.waypoint_radius_m of a street, and the ways of moving things
/// lie on the site.
Status check_places(const MissionConfig& config, const scene::Site& site);
/// The planned route, corners rounded, passes every waypoint within success.waypoint_radius_m: what follows it exactly
/// reaches them all.
Status check_route(const MissionConfig& config, const PriorKnowledge& prior);
/// There is ground under start and waypoints: that of a scene from files may have holes.
Status check_ground(const MissionConfig& config, const scene::Scene& scene);
/// Where the route stops for a building, success.facade_share of the facade is in sight of a camera camera_height_m
/// above the ground, past all that stands still.
Status check_sight(const MissionConfig& config, const PriorKnowledge& prior, const scene::Scene& scene);

/// That the vehicle touches nothing where it starts, by the check that scores it; things move as they do at the start.
Status check_start_is_free(const MissionConfig& config, const PreparedMission& mission);
/// The vehicle can come to within success.waypoint_radius_m of every waypoint, past what stands. Of moving things these
/// are those that stand from when the vehicle is there at the soonest, at its highest speed on a straight line, to the
/// mission's own limit. Only what cannot be is refused (mission/config/waypoint_reach.h).
Status check_waypoints_are_free(const MissionConfig& config, const PreparedMission& mission);

}  // namespace canyon::mission
