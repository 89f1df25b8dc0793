#include "canyon/mission/config/place_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "canyon/core/config/text.h"
#include "canyon/mission/autonomy/facade.h"
#include "canyon/mission/collision/collision.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/config/waypoint_reach.h"
#include "canyon/mission/motion/vehicle.h"

namespace canyon::mission {

namespace {

std::string place(const Eigen::Vector2d& p) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.1f, %.1f)", p.x(), p.y());
  return text;
}

std::string tenths(double value) {
  char text[48];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

std::string waypoint_key(std::size_t i) {
  return "autonomy.waypoint[" + std::to_string(i + 1) + "]";
}

std::string quoted(const Waypoint& waypoint) {
  return "waypoint \"" + waypoint.name + "\"";
}

/// The ground's corners, and the keys that they follow from.
struct Corners {
  Eigen::Vector2d low, high;
  std::string keys;
};

Error outside(const std::string& key, const std::string& who, const Eigen::Vector2d& p, const Corners& ground) {
  if ((ground.low.array() > ground.high.array()).any())
    return Error{.key = key, .what = "the scene is empty", .expected = "something to stand on (" + ground.keys + ")"};
  return Error{.key = key,
               .what = who + place(p) + " lies outside the scene",
               .expected = "x from " + number_text(ground.low.x()) + " to " + number_text(ground.high.x()) +
                           ", y from " + number_text(ground.low.y()) + " to " + number_text(ground.high.y()) + " (" +
                           ground.keys + ")"};
}

/// A point where a vehicle can stand. `who` is to stand there.
Status check_standing_place(const scene::Site& site, const Eigen::Vector2d& p, const std::string& key,
                            const std::string& who) {
  if (!site.contains(p)) return outside(key, who, p, {site.low_W, site.high_W, site.extent_keys});
  if (const scene::Building* building = scene::building_at(site.buildings, p))
    return Error{
        .key = key, .what = who + place(p) + " lies inside " + building->name, .expected = "a place outside buildings"};
  return Ok{};
}

Status check_building(const Waypoint& waypoint, std::size_t i, const scene::Site& site) {
  std::vector<std::string> names;
  for (const auto& building : site.buildings) names.push_back(building.name);
  if (std::find(names.begin(), names.end(), waypoint.observe) != names.end()) return Ok{};
  const std::string nearest = nearest_word(waypoint.observe, names);
  return Error{.key = waypoint_key(i),
               .what = quoted(waypoint) + ": no building named \"" + waypoint.observe + "\"",
               .expected = "a building of the scene" + (nearest.empty() ? "" : "; nearest is \"" + nearest + "\"")};
}

}  // namespace

Status check_places(const MissionConfig& config, const scene::Site& site) {
  CANYON_TRY_STATUS(check_standing_place(site, config.vehicle.start_m, "vehicle.start_m", ""));
  for (std::size_t i = 0; i < config.autonomy.waypoints.size(); ++i) {
    const Waypoint& waypoint = config.autonomy.waypoints[i];
    CANYON_TRY_STATUS(check_standing_place(site, waypoint.p_m, waypoint_key(i), quoted(waypoint) + " at "));
    if (waypoint.is_mission() && !config.scene.city.empty) CANYON_TRY_STATUS(check_building(waypoint, i, site));
    const double radius_m = config.success.waypoint_radius_m, aside_m = site.streets.distance_to(waypoint.p_m);
    if (std::isfinite(aside_m) && aside_m > radius_m)
      return Error{.key = waypoint_key(i) + ", success.waypoint_radius_m",
                   .what = quoted(waypoint) + " at " + place(waypoint.p_m) + " lies " + tenths(aside_m) +
                           " m from the nearest street's centre line",
                   .expected = "a place within success.waypoint_radius_m = " + number_text(radius_m) + " m of one"};
  }
  return scene::check_ways(config.scene.moving, site);
}

Status check_route(const MissionConfig& config, const PriorKnowledge& prior) {
  for (std::size_t i = 0; i < config.autonomy.waypoints.size(); ++i) {
    const Waypoint& waypoint = config.autonomy.waypoints[i];
    const double radius_m = config.success.waypoint_radius_m;
    const double aside_m = (prior.route.at(prior.waypoint_s_m[i]) - waypoint.p_m).norm();
    if (aside_m > radius_m)
      return Error{.key = waypoint_key(i) + ", autonomy.corner_radius_m, success.waypoint_radius_m",
                   .what = "the route, its corners rounded, passes " + quoted(waypoint) + " at a distance of " +
                           tenths(aside_m) + " m",
                   .expected = "at most success.waypoint_radius_m = " + number_text(radius_m) +
                               " m: a place off the corner, or a smaller autonomy.corner_radius_m"};
  }
  return Ok{};
}

Status check_ground(const MissionConfig& config, const scene::Scene& scene) {
  const Corners ground{scene.extent().min.head<2>(), scene.extent().max.head<2>(), scene::extent_keys(config.scene)};
  const Eigen::Vector2d& start = config.vehicle.start_m;
  if (!scene.ground(start.x(), start.y())) return outside("vehicle.start_m", "", start, ground);
  for (std::size_t i = 0; i < config.autonomy.waypoints.size(); ++i) {
    const Waypoint& waypoint = config.autonomy.waypoints[i];
    if (!scene.ground(waypoint.p_m.x(), waypoint.p_m.y()))
      return outside(waypoint_key(i), quoted(waypoint) + " at ", waypoint.p_m, ground);
  }
  return Ok{};
}

Status check_sight(const MissionConfig& config, const PriorKnowledge& prior, const scene::Scene& scene) {
  const scene::SceneAt still(scene);
  for (std::size_t i = 0; i < config.autonomy.waypoints.size(); ++i) {
    const Waypoint& waypoint = config.autonomy.waypoints[i];
    if (!waypoint.is_mission()) continue;
    const Eigen::Vector2d stop = prior.route.at(prior.waypoint_s_m[i]);
    const auto ground = scene.ground(stop.x(), stop.y());
    for (const scene::Building& building : scene.buildings()) {
      if (building.name != waypoint.observe || !ground) continue;
      const Eigen::Vector3d camera(stop.x(), stop.y(), ground->height_m + config.success.camera_height_m);
      const double share = visible_share(still, camera, facade_points(building, waypoint.p_m));
      if (share < config.success.facade_share)
        return Error{.key = waypoint_key(i) + ", success.facade_share, success.camera_height_m",
                     .what = quoted(waypoint) + ": from its stop at " + place(stop) + " " + tenths(100.0 * share) +
                             " % of the facade of " + building.name + " is in sight",
                     .expected = "at least success.facade_share = " + number_text(config.success.facade_share)};
    }
  }
  return Ok{};
}

Status check_start_is_free(const MissionConfig& config, const PreparedMission& mission) {
  scene::SceneAt at(*mission.scene);
  if (!mission.traffic.empty()) at.set_instances(mission.traffic.at(0.0));
  const Vehicle vehicle(config.vehicle, *mission.scene, static_cast<std::uint64_t>(config.run.seed), mission.start);
  const auto check = model_row(collision_checks(), config.success.collision.name)
                         .make(config.success.collision.own, config.vehicle, at);
  const auto touched = check->touched(vehicle.state());
  if (!touched) return Ok{};
  return Error{.key = "vehicle.start_m",
               .what = place(config.vehicle.start_m) + ": the body touches " + at.object(*touched).name + " there",
               .expected = "a place where it stands free"};
}

Status check_waypoints_are_free(const MissionConfig& config, const PreparedMission& mission) {
  const double radius_m = config.success.waypoint_radius_m;
  const double limit_s = config.success.limit_factor * mission.nominal_s;
  for (std::size_t i = 0; i < config.autonomy.waypoints.size(); ++i) {
    const Waypoint& waypoint = config.autonomy.waypoints[i];
    const double s_m = mission.prior.waypoint_s_m[i];
    // On the straight line, which no way is shorter than: nobody has to keep to the route.
    const double line_m = (waypoint.p_m - config.vehicle.start_m).norm();
    const double soonest_s = std::max(0.0, line_m - radius_m) / config.vehicle.max_speed_m_s;
    const std::vector<std::size_t> standing = mission.traffic.standing(soonest_s, limit_s);
    const std::vector<scene::Instance> moving = mission.traffic.at(soonest_s);
    std::vector<scene::Instance> still;
    for (const std::size_t k : standing) still.push_back(moving[k]);
    scene::SceneAt at(*mission.scene);
    if (!still.empty()) at.set_instances(std::move(still));

    const WaypointReach reach(config.vehicle, radius_m, at);
    const auto met = reach.met_before(mission.prior.route, s_m);
    if (!met || reach.way_to(waypoint.p_m).may_be) continue;
    const std::size_t fixed = mission.scene->objects().size();
    const std::string of_thing =
        *met < fixed ? "" : ", scene.moving[" + std::to_string(standing[*met - fixed] + 1) + "].path_m";
    return Error{.key = waypoint_key(i) + of_thing + ", success.waypoint_radius_m",
                 .what = quoted(waypoint) + " at " + place(waypoint.p_m) + ": " + at.object(*met).name +
                         " stands in the way, and the body comes to no place within success.waypoint_radius_m = " +
                         number_text(radius_m) + " m of it",
                 .expected = "a place that it can come to"};
  }
  return Ok{};
}

}  // namespace canyon::mission
