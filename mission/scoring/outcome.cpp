#include "canyon/mission/scoring/outcome.h"

namespace canyon::mission {
namespace {

constexpr ModelRow<Outcome> kOutcomes[] = {
    {"collision", Outcome::kCollision, "the body touches something; `detail` names it, what kind of thing it is first"},
    {"left_scene", Outcome::kLeftScene, "a wheel is off the terrain"},
    {"stuck", Outcome::kStuck, "the vehicle stands for `[success] stuck_after_s` without looking at a building"},
    {"autonomy_fault", Outcome::kAutonomyFault,
     "the autonomy gives a command that is not finite, throws, or takes longer than `[autonomy] call_limit_s` for one "
     "call; `detail` says which. It is what is under test, so this is a result like the others, and the exit status is "
     "0"},
    {"lost", Outcome::kLost,
     "the autonomy says that it no longer believes its estimate, and stands; `detail` says how far off that truly was"},
    {"timeout", Outcome::kTimeout, "`[success] limit_factor` times the nominal time is over"},
    {"stopped", Outcome::kStopped,
     "`[time] limit_s` is over, and it is shorter than that: neither success nor failure"},
    {"missed_waypoint", Outcome::kMissedWaypoint,
     "the autonomy has finished, but the vehicle was not within `[success] waypoint_radius_m` of every waypoint, in "
     "whatever order (a place that comes again wants as many visits), and stood there for `stop_s` where it is a "
     "mission waypoint; `detail` names the first one missed "
     "and the nearest distance"},
    {"no_line_of_sight", Outcome::kNoLineOfSight,
     "the same, and at a mission waypoint less than `facade_share` of the facade was in sight"},
    {"success", Outcome::kSuccess, "none of these"},
};

}  // namespace

ModelTable<Outcome> outcomes() {
  return kOutcomes;
}

}  // namespace canyon::mission
