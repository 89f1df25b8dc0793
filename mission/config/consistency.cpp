#include "canyon/mission/config/consistency.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "canyon/core/config/text.h"
#include "canyon/core/units.h"
#include "canyon/lidar/registration/registration.h"
#include "canyon/mission/autonomy/perception/street_weight.h"
#include "canyon/mission/autonomy/planning/plan_parameters.h"
#include "canyon/mission/autonomy/planning/tracker.h"
#include "canyon/mission/autonomy/reference.h"
#include "canyon/mission/autonomy/reference_2012.h"
#include "canyon/mission/autonomy/route_driver.h"
#include "canyon/mission/motion/plan/dynamic_bicycle.h"

namespace canyon::mission {

namespace {

/// A stop that the autonomy does not make cannot be scored.
Status check_stop(double stop_s, const AutonomyConfig& autonomy) {
  const bool stops = std::any_of(autonomy.waypoints.begin(), autonomy.waypoints.end(),
                                 [](const Waypoint& waypoint) { return waypoint.is_mission(); });
  if (stops && stop_s > autonomy.hold_s)
    return Error{.key = "success.stop_s, autonomy.hold_s",
                 .what = "a stop of " + number_text(stop_s) + " s is asked for, but the autonomy stops for " +
                         number_text(autonomy.hold_s) + " s",
                 .expected = "success.stop_s not above autonomy.hold_s"};
  return Ok{};
}

/// A halt must count where the autonomy makes it, however well it knows where it is.
Status check_radius(double radius_m) {
  if (radius_m >= kStopTolerance_m) return Ok{};
  return Error{.key = "success.waypoint_radius_m",
               .what = "a stop counts within " + number_text(radius_m) +
                       " m of its waypoint, and the autonomy halts up to " + number_text(kStopTolerance_m) +
                       " m before it",
               .expected = "success.waypoint_radius_m of " + number_text(kStopTolerance_m) + " or more"};
}

/// Backing up must be possible, and come before the run has ended.
Status check_recovery(const MissionConfig& config) {
  if (config.autonomy.model.name != "reference") return Ok{};
  const auto& recovery = config.autonomy.model.own.get<ReferenceParameters>().recovery.model;
  if (recovery.name != "back_up") return Ok{};
  if (config.vehicle.max_reverse_m_s <= 0.0)
    return Error{.key = "vehicle.max_reverse_m_s, autonomy.recovery.model",
                 .what = "the autonomy backs up where no way ahead is free, and the vehicle cannot",
                 .expected = "a vehicle.max_reverse_m_s above 0, or autonomy.recovery.model = \"wait\""};
  const double wait_s = back_up_wait_s(recovery.own), stuck_after_s = config.success.stuck_after_s;
  if (wait_s < stuck_after_s) return Ok{};
  return Error{.key = "autonomy.recovery.wait_s, success.stuck_after_s",
               .what = "the autonomy stands for " + number_text(wait_s) +
                       " s before it backs up, and counts as stuck " + "after " + number_text(stuck_after_s) + " s",
               .expected = "autonomy.recovery.wait_s below success.stuck_after_s"};
}

/// `first` must not be above `second`; `what` says what it means that it is.
struct Limit {
  const char* first_key;
  double first;
  const char* second_key;
  double second;
  std::string what;
};
Status check_limit(const Limit& limit) {
  if (limit.first <= limit.second) return Ok{};
  return Error{.key = std::string(limit.first_key) + ", " + limit.second_key,
               .what = limit.what,
               .expected = std::string(limit.first_key) + " not above " + limit.second_key};
}

Status check_body(const VehicleConfig& vehicle) {
  CANYON_TRY_STATUS(check_limit({"vehicle.wheelbase_m", vehicle.wheelbase_m, "vehicle.length_m", vehicle.length_m,
                                 "a wheelbase of " + number_text(vehicle.wheelbase_m) + " m under a body of " +
                                     number_text(vehicle.length_m) + " m"}));
  CANYON_TRY_STATUS(check_limit(
      {"vehicle.track_m", vehicle.track_m, "vehicle.width_m", vehicle.width_m,
       "a track of " + number_text(vehicle.track_m) + " m under a body " + number_text(vehicle.width_m) + " m wide"}));
  return check_limit({"vehicle.ground_clearance_m", vehicle.ground_clearance_m, "vehicle.height_m", vehicle.height_m,
                      "a body " + number_text(vehicle.height_m) + " m high that begins " +
                          number_text(vehicle.ground_clearance_m) + " m above the ground"});
}

/// What is asked of tyres, against what they hold.
Status check_grip(const AutonomyConfig& autonomy, const VehicleConfig& vehicle) {
  if (vehicle.model.name != "dynamic_bicycle") return Ok{};
  constexpr double kGravity_m_s2 = 9.80665;
  const double friction = vehicle.model.own.get<DynamicBicycleParameters>().tyre_friction;
  const double holds_m_s2 = kGravity_m_s2 * friction;
  const auto check = [&](const char* key, double asked_m_s2, const std::string& what) -> Status {
    if (asked_m_s2 <= holds_m_s2) return Ok{};
    char holds[48];
    std::snprintf(holds, sizeof holds, "%.1f m/s^2", holds_m_s2);
    return Error{.key = std::string(key) + ", vehicle.tyre_friction",
                 .what = what + number_text(asked_m_s2) + " m/s^2, its tyres hold " + holds,
                 .expected = std::string(key) + " not above vehicle.tyre_friction times gravity"};
  };
  CANYON_TRY_STATUS(check("vehicle.max_deceleration_m_s2", vehicle.max_deceleration_m_s2, "the vehicle brakes with "));
  return check("autonomy.lateral_m_s2", autonomy.lateral_m_s2, "the autonomy plans turns with ");
}

/// What the filter measures with must be there.
Status check_measurements(const MissionConfig& config) {
  CANYON_TRY_STATUS(fusion::check_parts(fusion::filter_parts(config.fusion)));
  if (fusion::measures_with(config.fusion, "relative_pose") && !lidar::registers(config.registration))
    return Error{.key = config.fusion.map_aiding ? "fusion.map_aiding" : "fusion.measurements",
                 .what = "the filter measures with registered scans, and none is registered",
                 .expected = "a registration.method"};
  if (fusion::measures_with(config.fusion, "ranges") && config.gnss.model.name != "pseudorange")
    return Error{.key = config.fusion.measurements.empty() ? "fusion.filter" : "fusion.measurements",
                 .what = "the filter measures with ranges, and gnss.model \"" + config.gnss.model.name + "\" has none",
                 .expected = "gnss.model = \"pseudorange\""};
  if (fusion::measures_with(config.fusion, "heading"))
    return Error{.key = "fusion.measurements",
                 .what = "\"heading\" is of recordings, a mission has no such sensor",
                 .expected = "measurements without it"};
  return Ok{};
}

/// An autonomy that works with registered poses must be given some.
Status check_registered_map(const MissionConfig& config) {
  if (config.autonomy.map != MapPose::kRegistered || lidar::registers(config.registration)) return Ok{};
  return Error{.key = "autonomy.map, registration.method",
               .what = "the autonomy works with the registered pose, and with method \"" +
                       config.registration.method.name + "\" nothing is registered",
               .expected = "another registration.method, or autonomy.map = \"prior\""};
}

/// A prior map is registered onto, and the filter's pose in it comes from that.
Status check_prior_map(const MissionConfig& config) {
  const bool given = !config.registration.prior_map.empty();
  if (given && !lidar::registers(config.registration))
    return Error{.key = "registration.prior_map",
                 .what = "with method \"" + config.registration.method.name + "\" nothing is registered onto a map",
                 .expected = "another registration.method"};
  if (!given && fusion::measures_with(config.fusion, "map_pose"))
    return Error{.key = "fusion.measurements",
                 .what = "\"map_pose\" is the pose in a map that was there before, and there is none",
                 .expected = "a registration.prior_map"};
  if (fusion::measures_with(config.fusion, "map_pose") && config.autonomy.map == MapPose::kRegistered)
    return Error{.key = "autonomy.map, fusion.measurements",
                 .what = "the filter has \"map_pose\", and the registered map would move its estimate once more",
                 .expected = "autonomy.map = \"prior\", or measurements without it"};
  return Ok{};
}

/// Keys of an autonomy that does not drive contradict nothing.
bool is_2012(const AutonomyConfig& autonomy) {
  return autonomy.model.name == "reference_2012";
}

/// The least of each of the autonomy's own keys, against the most. Those of a part that is not chosen say nothing.
Status check_ranges(const AutonomyConfig& autonomy) {
  if (is_2012(autonomy)) {
    const PathChoiceConfig& choice = autonomy.model.own.get<Reference2012Parameters>().choice;
    return check_limit({"autonomy.choice.stop_margin_m", choice.stop_margin_m, "autonomy.choice.horizon_m",
                        choice.horizon_m,
                        "it halts " + number_text(choice.stop_margin_m) + " m before what it looks for only " +
                            number_text(choice.horizon_m) + " m ahead"});
  }
  if (autonomy.model.name != "reference") return Ok{};
  const auto& parts = autonomy.model.own.get<ReferenceParameters>();
  if (parts.lane.model.name != "route") {
    const auto& sides = parts.lane.model.own.get<StreetSidesParameters>();
    CANYON_TRY_STATUS(
        check_limit({"autonomy.lane.narrowest_m", sides.narrowest_m, "autonomy.lane.widest_m", sides.widest_m,
                     "no street is " + number_text(sides.narrowest_m) + " m wide or more and " +
                         number_text(sides.widest_m) + " m or less"}));
  }
  const auto& plan = parts.planner.model.own.get<PlanParameters>();
  CANYON_TRY_STATUS(check_limit({"autonomy.planner.clearance_m", plan.clearance_m,
                                 "autonomy.planner.comfort_clearance_m", plan.comfort_clearance_m,
                                 "nearer than " + number_text(plan.comfort_clearance_m) +
                                     " m costs, and no way is nearer than " + number_text(plan.clearance_m) + " m"}));
  if (parts.tracker.model.name != "pure_pursuit") return Ok{};
  const Lookahead ahead = pure_pursuit_lookahead(parts.tracker.model.own);
  return check_limit({"autonomy.tracker.lookahead_min_m", ahead.min_m, "autonomy.tracker.lookahead_max_m", ahead.max_m,
                      "it steers for a point no nearer than " + number_text(ahead.min_m) + " m and no farther than " +
                          number_text(ahead.max_m) + " m"});
}

/// What the autonomy plans with, against what the vehicle can do.
Status check_driving(const AutonomyConfig& autonomy, const VehicleConfig& vehicle) {
  CANYON_TRY_STATUS(
      check_limit({"autonomy.cruise_m_s", autonomy.cruise_m_s, "vehicle.max_speed_m_s", vehicle.max_speed_m_s,
                   "the autonomy plans with " + number_text(autonomy.cruise_m_s) + " m/s, the vehicle drives at most " +
                       number_text(vehicle.max_speed_m_s) + " m/s"}));
  CANYON_TRY_STATUS(check_limit(
      {"autonomy.braking_m_s2", autonomy.braking_m_s2, "vehicle.max_deceleration_m_s2", vehicle.max_deceleration_m_s2,
       "the autonomy plans with " + number_text(autonomy.braking_m_s2) + " m/s^2, the vehicle brakes with at most " +
           number_text(vehicle.max_deceleration_m_s2) + " m/s^2"}));
  const double tightest_m = vehicle.wheelbase_m / std::tan(vehicle.max_steering_deg * kDegree);
  if (autonomy.corner_radius_m < tightest_m) {
    char text[96];
    std::snprintf(text, sizeof text, "the vehicle's tightest turn has a radius of %.2f m, turns of %.2f m are planned",
                  tightest_m, autonomy.corner_radius_m);
    return Error{.key = "autonomy.corner_radius_m, vehicle.max_steering_deg, vehicle.wheelbase_m",
                 .what = text,
                 .expected = "autonomy.corner_radius_m of vehicle.wheelbase_m / tan(vehicle.max_steering_deg) or more"};
  }
  const Reference2012Parameters& reference = autonomy.model.own.get<Reference2012Parameters>();
  if (is_2012(autonomy) && reference.clearance_m < 0.5 * vehicle.width_m)
    return Error{.key = "autonomy.clearance_m, vehicle.width_m",
                 .what = "a vehicle " + number_text(vehicle.width_m) + " m wide does not pass an obstacle " +
                         number_text(reference.clearance_m) + " m beside its axis",
                 .expected = "autonomy.clearance_m of half vehicle.width_m or more"};
  return Ok{};
}

/// What the autonomy looks at, against what it is shown.
Status check_seeing(const AutonomyConfig& autonomy, double lidar_hz) {
  const Reference2012Parameters& of_2012 = autonomy.model.own.get<Reference2012Parameters>();
  if (is_2012(autonomy)) {
    CANYON_TRY_STATUS(check_limit({"autonomy.choice.horizon_m", of_2012.choice.horizon_m, "autonomy.grid.half_size_m",
                                   of_2012.grid.half_size_m,
                                   "paths are checked " + number_text(of_2012.choice.horizon_m) +
                                       " m ahead, the grid reaches " + number_text(of_2012.grid.half_size_m) + " m"}));
  }
  const double period_s = 1.0 / lidar_hz;
  if (autonomy.blind_after_s >= period_s * (1.0 - 1e-9)) return Ok{};
  return Error{.key = "autonomy.blind_after_s, lidar.rate_hz",
               .what = "the autonomy takes itself for blind after " + number_text(autonomy.blind_after_s) +
                       " s, a scan comes every " + number_text(period_s) + " s",
               .expected = "autonomy.blind_after_s of 1 / lidar.rate_hz or more"};
}

}  // namespace

Status check_consistency(const MissionConfig& config) {
  CANYON_TRY_STATUS(
      check_limit({"scene.kerb_height_m", config.scene.city.kerb_height_m, "vehicle.ground_clearance_m",
                   config.vehicle.ground_clearance_m,
                   "kerbs of " + number_text(config.scene.city.kerb_height_m) + " m under a body that begins " +
                       number_text(config.vehicle.ground_clearance_m) + " m above the ground"}));
  CANYON_TRY_STATUS(check_stop(config.success.stop_s, config.autonomy));
  CANYON_TRY_STATUS(check_radius(config.success.waypoint_radius_m));
  CANYON_TRY_STATUS(check_recovery(config));
  CANYON_TRY_STATUS(check_body(config.vehicle));
  CANYON_TRY_STATUS(check_grip(config.autonomy, config.vehicle));
  CANYON_TRY_STATUS(check_driving(config.autonomy, config.vehicle));
  CANYON_TRY_STATUS(check_ranges(config.autonomy));
  CANYON_TRY_STATUS(check_measurements(config));
  CANYON_TRY_STATUS(check_prior_map(config));
  CANYON_TRY_STATUS(check_registered_map(config));
  return check_seeing(config.autonomy, config.lidar.rate_hz);
}

}  // namespace canyon::mission
