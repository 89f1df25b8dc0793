#include "canyon/study/results/figures.h"

#include <array>
#include <cmath>

namespace canyon::study {

namespace {

using enum Better;
using enum Figure::Kind;
using Run = RunSummary;

/// Undefined in an open loop: nobody drove.
double if_driven(const Run& r, double value) {
  return r.open_loop ? kNaN : value;
}

double planned(const Run& r, bool mission_only) {
  double count = 0;
  for (const auto& waypoint : r.waypoints) count += waypoint.mission || !mission_only ? 1 : 0;
  return if_driven(r, count);
}

/// The least or the most over mission waypoints that were looked at; NaN if none was.
double over_views(const Run& r, double mission::WaypointScore::*value, double sign) {
  double most = kNaN;
  for (const auto& waypoint : r.waypoints) {
    const double one = sign * waypoint.*value;
    if (waypoint.mission && !std::isnan(waypoint.facade_range_m) && !(one <= most)) most = one;
  }
  return sign * most;
}

const mission::Sighting* sighting(const Run& r) {
  return r.failure && r.failure->seen ? &*r.failure->seen : nullptr;
}

bool hit(const Run& r) {
  return r.failure && r.failure->kind == mission::Outcome::kCollision;
}

double optional_count(const std::optional<int>& count) {
  return count ? *count : kNaN;
}

/// Without registration there is no registered map, not an empty one.
double if_registered(const Run& r, double value) {
  return r.keyframes_registered ? value : kNaN;
}

/// Nor is a map that nobody asked for an empty one.
double if_mapped(const Run& r, double value) {
  return r.maps_made ? value : kNaN;
}

double capped_share(const lidar::MapQuality& map) {
  return map.points > 0 ? static_cast<double>(map.capped_points) / static_cast<double>(map.points) : kNaN;
}

// Rows with what few rows have.
constexpr Figure with_interval(Figure figure, Interval (*interval)(const Run&)) {
  figure.interval = interval;
  return figure;
}
constexpr Figure capped(Figure figure) {
  figure.cap = lidar::kMapErrorCap_m;
  return figure;
}
constexpr Figure far_capped(Figure figure) {
  figure.cap = mission::Encounters::kFar_m;
  return figure;
}
constexpr Figure timing(Figure figure) {
  figure.timing = true;
  return figure;
}

static_assert(lidar::kMapErrorCap_m == 5.0, "the words below say 5 m");
static_assert(mission::Encounters::kFar_m == 3.0, "the words below say 3 m");
static_assert(mission::LaneDepartures::kBeside_m == 0.5 && mission::LaneDepartures::kClear_m == 1.0 &&
                  mission::LaneDepartures::kAhead_m == 30.0 && mission::LaneDepartures::kBack_m == 30.0,
              "the words below say 0.5 m, 1 m and 30 m");

constexpr const char *kMission = "Mission", *kPosition = "Position error", *kAttitude = "Attitude error",
                     *kSky = "Satellites", *kMap = "Registration and map", *kCost = "Cost";

// clang-format off
constexpr auto kFigures = std::to_array<Figure>({
    {kMission, "waypoints_reached", "", "waypoints reached", kHigher, kCount, 0,
     [](const Run& r) { return if_driven(r, r.waypoints_reached); },
     "on truth within [success] waypoint_radius_m", "waypoints_planned"},
    {kMission, "mission_waypoints_reached", "", "mission waypoints reached", kHigher, kCount, 0,
     [](const Run& r) { return if_driven(r, r.mission_waypoints_reached); },
     "on truth within [success] waypoint_radius_m, with a stop of [success] stop_s", "mission_waypoints_planned"},
    {kMission, "waypoints_planned", "", "waypoints", kNeither, kCount, 0, [](const Run& r) { return planned(r, false); }},
    {kMission, "mission_waypoints_planned", "", "mission waypoints", kNeither, kCount, 0, [](const Run& r) { return planned(r, true); }},
    {kMission, "waypoints_believed_only", "", "waypoints believed reached, but not", kLower, kCount, 0,
     [](const Run& r) { return if_driven(r, r.believed_not_reached); },
     "the autonomy went on to the next; summary.json says how far off it was"},
    {kMission, "facade_px_per_m_min", "1/m", "sharpness of the worst view of a facade", kHigher, kQuantity, 1,
     [](const Run& r) { return over_views(r, &mission::WaypointScore::facade_px_per_m, -1.0); },
     "pixels along a metre of its width, by range and obliquity, of a camera of [success] camera_px_per_rad"},
    {kMission, "facade_range_max_m", "m", "longest range to a facade looked at", kLower, kQuantity, 1,
     [](const Run& r) { return over_views(r, &mission::WaypointScore::facade_range_m, 1.0); }},
    {kMission, "facade_obliquity_max_deg", "deg", "most oblique view of a facade", kLower, kQuantity, 1,
     [](const Run& r) { return over_views(r, &mission::WaypointScore::facade_obliquity_deg, 1.0); }, "from its normal"},
    {kMission, "facade_least_seen_share", "%", "facade in sight, least", kHigher, kShare, 1,
     [](const Run& r) { return over_views(r, &mission::WaypointScore::facade_seen_share, -1.0); }, "the rest is hidden"},
    far_capped({kMission, "clearance_min_m", "m", "least distance to a thing", kHigher, kQuantity, 2,
     [](const Run& r) { return if_driven(r, r.encounters.clearance_min_m); },
     "of the true body to anything but the ground; 3 m stands for 3 m or more, 0 for touching"}),
    {kMission, "near_misses", "", "near misses", kLower, kCount, 0, [](const Run& r) { return if_driven(r, r.encounters.near_misses); },
     "times that a thing was nearer than [success] near_miss_m to the true body, without being touched"},
    {kMission, "phantoms_per_km", "1/km", "phantoms", kLower, kQuantity, 2,
     [](const Run& r) { return if_driven(r, r.per_km(r.encounters.phantoms)); },
     "times that the autonomy found no way with [success] phantom_free_m ahead of the true body free; one that it only steers around is a needless lane departure"},
    {kMission, "needless_lane_departures_per_km", "1/km", "needless lane departures", kLower, kQuantity, 2,
     [](const Run& r) { return if_driven(r, r.per_km(r.needless_lane_departures)); },
     "times that the true vehicle was more than 0.5 m beside its route, beyond what the error of its pose explains, with nothing but kerbs within 1 m of "
     "the body's way along it for 30 m ahead, nor over the 30 m before, and no turn sharper than the vehicle can steer over 5 m ahead or 15 m before: a phantom steered around, or a lane put elsewhere by what is seen of the street"},
    {kMission, "missed_obstacles_per_km", "1/km", "missed obstacles", kLower, kQuantity, 2,
     [](const Run& r) { return if_driven(r, r.per_km(r.encounters.missed_obstacles)); },
     "times that a thing lay on the arc truly driven, nearer than full braking stops, and no less speed was asked for"},
    {kMission, "hit_in_scans_s", "s", "what was hit stood in the scans for", kNeither, kQuantity, 1,
     [](const Run& r) { const auto* seen = sighting(r); return seen != nullptr ? seen->stood_s : hit(r) ? 0.0 : kNaN; },
     "without a gap of 0.5 s, up to the last scan that showed it; 0 where none did; null without a collision"},
    {kMission, "hit_last_range_m", "m", "its distance in the last of them", kNeither, kQuantity, 1,
     [](const Run& r) { const auto* seen = sighting(r); return seen != nullptr ? seen->range_m : kNaN; },
     "of its nearest return, from the LIDAR"},
    {kMission, "hit_last_seen_s", "s", "and how long before that was", kNeither, kQuantity, 2,
     [](const Run& r) { const auto* seen = sighting(r); return seen != nullptr ? seen->ago_s : kNaN; }},
    {kMission, "duration_s", "s", "duration", kNeither, kQuantity, 1, [](const Run& r) { return r.duration_s; }},
    {kMission, "distance_m", "m", "distance driven", kNeither, kQuantity, 0, [](const Run& r) { return r.distance_m; }},

    with_interval({kPosition, "position_error_rms_m", "m", "position error, RMS", kLower, kQuantity, 3, [](const Run& r) { return r.position_m.rms; },
     "3-D, filter's estimate against truth; interval of the drive's own mean square, by means over 30 s"},
                  [](const Run& r) { return r.position_rms_interval_m; }),
    {kPosition, "position_error_p95_m", "m", "position error, 95 %", kLower, kQuantity, 3, [](const Run& r) { return r.position_m.p95; }},
    {kPosition, "position_error_max_m", "m", "position error, largest", kLower, kQuantity, 3, [](const Run& r) { return r.position_m.max; }},
    {kPosition, "position_error_e_rms_m", "m", "east error, RMS", kLower, kQuantity, 3, [](const Run& r) { return r.east_m.rms; }},
    {kPosition, "position_error_e_p95_m", "m", "east error, 95 %", kLower, kQuantity, 3, [](const Run& r) { return r.east_m.p95; }},
    {kPosition, "position_error_e_max_m", "m", "east error, largest", kLower, kQuantity, 3, [](const Run& r) { return r.east_m.max; }},
    {kPosition, "position_error_n_rms_m", "m", "north error, RMS", kLower, kQuantity, 3, [](const Run& r) { return r.north_m.rms; }},
    {kPosition, "position_error_n_p95_m", "m", "north error, 95 %", kLower, kQuantity, 3, [](const Run& r) { return r.north_m.p95; }},
    {kPosition, "position_error_n_max_m", "m", "north error, largest", kLower, kQuantity, 3, [](const Run& r) { return r.north_m.max; }},
    {kPosition, "position_error_up_rms_m", "m", "up error, RMS", kLower, kQuantity, 3, [](const Run& r) { return r.up_m.rms; }},
    {kPosition, "position_error_up_p95_m", "m", "up error, 95 %", kLower, kQuantity, 3, [](const Run& r) { return r.up_m.p95; }},
    {kPosition, "position_error_up_max_m", "m", "up error, largest", kLower, kQuantity, 3, [](const Run& r) { return r.up_m.max; }},

    {kAttitude, "attitude_error_roll_rms_deg", "deg", "roll error, RMS", kLower, kQuantity, 3, [](const Run& r) { return r.roll_rms_deg; },
     "of the rotation from the true to the estimated body"},
    {kAttitude, "attitude_error_pitch_rms_deg", "deg", "pitch error, RMS", kLower, kQuantity, 3, [](const Run& r) { return r.pitch_rms_deg; }},
    {kAttitude, "attitude_error_yaw_rms_deg", "deg", "yaw error, RMS", kLower, kQuantity, 3, [](const Run& r) { return r.yaw_rms_deg; }},

    {kSky, "gdop_median", "", "GDOP, median", kLower, kQuantity, 2, [](const Run& r) { return r.gdop_median; },
     "over epochs with a fix; as all that speaks of satellites, null for a GNSS model that makes fixes without them"},
    {kSky, "gdop_max", "", "GDOP, largest", kLower, kQuantity, 2, [](const Run& r) { return r.gdop_max; }},
    {kSky, "pdop_median", "", "PDOP, median", kLower, kQuantity, 2, [](const Run& r) { return r.pdop_median; }},
    {kSky, "dop_jumps", "", "DOP jumps", kLower, kCount, 0, [](const Run& r) { return optional_count(r.dop_jumps); },
     "GDOP more than 2 from the epoch before, or a fix lost or regained"},
    {kSky, "satellites_mean", "", "satellites in the fix, mean", kHigher, kQuantity, 1, [](const Run& r) { return r.satellites_mean; }},
    {kSky, "nlos_share", "%", "NLOS share of tracked", kLower, kShare, 1, [](const Run& r) { return r.nlos_share; },
     "tracked satellites whose direct path is blocked"},
    {kSky, "multipath_share", "%", "multipath share of tracked", kLower, kShare, 1, [](const Run& r) { return r.multipath_share; },
     "tracked satellites received directly and by reflection"},
    {kSky, "fix_error_rms_m", "m", "fix error, RMS", kLower, kQuantity, 3, [](const Run& r) { return r.fix_error_rms_m; },
     "3-D, receiver's fix against truth; fixes.rms_m of evidence is per axis"},
    {kSky, "fixes_due", "", "fixes due", kNeither, kCount, 0, [](const Run& r) -> double { return r.fixes_due; }},
    {kSky, "fixes_lost", "", "fixes lost", kLower, kCount, 0, [](const Run& r) -> double { return r.fixes_lost; },
     "due epochs without a solution", "fixes_due"},

    {kMap, "registration_error_prior_rms_m", "m", "keyframe error, prior, RMS", kLower, kQuantity, 3,
     [](const Run& r) { return r.registration_prior_rms_m; }, "placed by the filter alone"},
    {kMap, "registration_error_rms_m", "m", "keyframe error, registered, RMS", kLower, kQuantity, 3,
     [](const Run& r) { return r.registration_rms_m; },
     "alignment and filter's pose weighed by their covariances; as all that is registered, null with [registration] method \"none\""},
    {kMap, "keyframes", "", "keyframes", kNeither, kCount, 0, [](const Run& r) { return optional_count(r.keyframes); }},
    {kMap, "keyframes_registered", "", "keyframes registered", kNeither, kCount, 0,
     [](const Run& r) { return optional_count(r.keyframes_registered); }, "aligned with those before; all but the first", "keyframes"},
    {kMap, "keyframes_converged", "", "keyframes converged", kHigher, kCount, 0,
     [](const Run& r) { return optional_count(r.keyframes_converged); }, "", "keyframes_registered"},
    {kMap, "map_error_prior_rms_m", "m", "map error, prior, RMS", kLower, kQuantity, 3,
     [](const Run& r) { return r.prior_map.map_error_rms_m; }, "map points to the nearest true surface"},
    {kMap, "map_error_rms_m", "m", "map error, registered, RMS", kLower, kQuantity, 3, [](const Run& r) { return r.registered_map.map_error_rms_m; }},
    capped({kMap, "map_error_p95_prior_m", "m", "map error, prior, 95 %", kLower, kQuantity, 3, [](const Run& r) { return r.prior_map.map_error_p95_m; },
     "points farther than 5 m from any surface count as 5 m"}),
    capped({kMap, "map_error_p95_m", "m", "map error, registered, 95 %", kLower, kQuantity, 3, [](const Run& r) { return r.registered_map.map_error_p95_m; }}),
    {kMap, "map_error_up_prior_rms_m", "m", "map error up, prior, RMS", kLower, kQuantity, 3,
     [](const Run& r) { return r.prior_map.map_error_up_rms_m; },
     "height above the nearest true surface point, over points next to level ground or a roof (within 30 degrees, no tree): what a wall "
     "cannot show, since one lifted by 2 m still lies on itself"},
    {kMap, "map_error_up_rms_m", "m", "map error up, registered, RMS", kLower, kQuantity, 3,
     [](const Run& r) { return r.registered_map.map_error_up_rms_m; }},
    {kMap, "map_points", "", "map points", kNeither, kCount, 0,
     [](const Run& r) { return if_mapped(r, static_cast<double>(r.keyframes_registered ? r.registered_map.points : r.prior_map.points)); },
     "of the registered map, or of the prior one where there is no other"},
    {kMap, "map_points_level_prior", "", "map points on level surfaces, prior", kNeither, kCount, 0,
     [](const Run& r) { return if_mapped(r, static_cast<double>(r.prior_map.up_points)); }, "those that the map error up is taken over"},
    {kMap, "map_points_level", "", "map points on level surfaces, registered", kNeither, kCount, 0,
     [](const Run& r) { return if_mapped(r, if_registered(r, static_cast<double>(r.registered_map.up_points))); }},
    {kMap, "map_points_capped_prior", "", "map points capped, prior", kLower, kCount, 0,
     [](const Run& r) { return if_mapped(r, static_cast<double>(r.prior_map.capped_points)); }, "no true surface within 5 m"},
    {kMap, "map_points_capped", "", "map points capped, registered", kLower, kCount, 0,
     [](const Run& r) { return if_mapped(r, if_registered(r, static_cast<double>(r.registered_map.capped_points))); }},
    {kMap, "map_capped_prior_share", "%", "share of points capped, prior", kLower, kShare, 1, [](const Run& r) { return capped_share(r.prior_map); }},
    {kMap, "map_capped_share", "%", "share of points capped, registered", kLower, kShare, 1,
     [](const Run& r) { return if_registered(r, capped_share(r.registered_map)); }},

    timing({kCost, "real_time_factor", "", "real-time factor", kHigher, kQuantity, 1, [](const Run& r) { return r.real_time_factor(); },
     "simulated seconds per second of wall time"}),
    timing({kCost, "wall_s", "s", "wall time", kLower, kQuantity, 1, [](const Run& r) { return r.wall_s; },
     ""}),
    timing({kCost, "cpu_s", "s", "CPU time", kLower, kQuantity, 1, [](const Run& r) { return r.cpu_s; },
     "of all threads that worked for the run"}),
    timing({kCost, "cpu_per_simulated_s", "s", "CPU time per simulated second", kLower, kQuantity, 3, [](const Run& r) { return r.cpu_per_simulated_s(); },
     "fair also to a run that ended early"}),
});
// clang-format on

}  // namespace

std::span<const Figure> figures() {
  return kFigures;
}

}  // namespace canyon::study
