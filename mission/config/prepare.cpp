#include <algorithm>

#include "canyon/core/check.h"
#include "canyon/core/files/files.h"
#include "canyon/inertial/imu_model.h"
#include "canyon/lidar/files/map_files.h"
#include "canyon/lidar/scanner.h"
#include "canyon/mission/config/consistency.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/config/place_checks.h"

namespace canyon::mission {

namespace {

/// What the configuration names, read to the end: a file that is not there is told before anything is built.
Result<std::vector<InputFile>> read_inputs(const MissionConfig& config) {
  std::vector<InputFile> files;
  MissionConfig copy = config;
  for (const NamedFile& named : named_files([&copy](FieldVisitor& f) { visit(f, copy); })) {
    const auto bytes = read_text_file(named.path);
    if (!bytes)
      return Error{
          .key = named.key, .what = "\"" + named.path + "\" " + bytes.error().what, .expected = bytes.error().expected};
    files.push_back({named.path, sha256_hex(*bytes)});
  }
  return files;
}

/// Route and limits, from what the site tells.
Status plan(const MissionConfig& config, const scene::Site& site, PreparedMission& mission) {
  CANYON_TRY_STATUS(check_places(config, site));
  CANYON_TRY(mission.prior, plan_route(config.autonomy, site.streets, config.vehicle.start_m));
  mission.prior.vehicle = known_vehicle(config.vehicle);
  mission.prior.vehicle.counted_wheel_left_m = config.odometer.wheel_m.y();
  CANYON_TRY_STATUS(check_route(config, mission.prior));
  std::vector<double> stops{mission.prior.route.length_m()};
  double holds_s = 0.0;
  for (std::size_t i = 0; i < config.autonomy.waypoints.size(); ++i) {
    if (!config.autonomy.waypoints[i].is_mission()) continue;
    stops.push_back(mission.prior.waypoint_s_m[i]);
    holds_s += config.autonomy.hold_s;
  }
  mission.nominal_s = holds_s + nominal_drive_time_s(mission.prior.route,
                                                     {.cruise_m_s = config.autonomy.cruise_m_s,
                                                      .lateral_m_s2 = config.autonomy.lateral_m_s2,
                                                      .acceleration_m_s2 = config.vehicle.max_acceleration_m_s2,
                                                      .deceleration_m_s2 = config.autonomy.braking_m_s2,
                                                      .max_yaw_rate_rad_s = mission.prior.vehicle.max_yaw_rate_rad_s},
                                                     stops);
  mission.time_limit_s = config.success.limit_factor * mission.nominal_s;
  if (config.time.limit_s > 0.0) mission.time_limit_s = std::min(mission.time_limit_s, config.time.limit_s);
  return Ok{};
}

Status check_prior_map(const std::string& path) {
  if (path.empty()) return Ok{};
  const auto map = lidar::read_prior_map(path);
  if (map) return Ok{};
  const Error& wrong = map.error();
  const std::string line = wrong.line > 0 ? "line " + std::to_string(wrong.line) + ": " : "";
  return Error{
      .key = "registration.prior_map", .what = '"' + path + "\" " + line + wrong.what, .expected = wrong.expected};
}

/// Builds every sensor once and throws it away: finds an unreadable navigation file or an unknown catalogue entry
/// before any time is spent. Of the scene they need its frame.
Status check_sensors(const MissionConfig& config, const PreparedMission& mission, const scene::Scene& scene) {
  const auto seed = static_cast<std::uint64_t>(config.run.seed);
  const GpsTime end = mission.start + mission.time_limit_s;
  CANYON_TRY_STATUS(gnss::make_gnss_sensor(config.gnss, seed, mission.start, end, scene));
  CANYON_TRY_STATUS(inertial::make_imu(config.imu, seed, scene.frame()));
  CANYON_TRY_STATUS(noise_told_to_filter(config));
  CANYON_TRY_STATUS(lidar::make_scanner(config.lidar, seed));
  CANYON_TRY_STATUS(lidar::make_registration(config.registration));
  return check_prior_map(config.registration.prior_map);
}

/// The smallest bare city at the same place.
scene::Scene stand_in(const scene::CityConfig& city) {
  scene::CityConfig small;
  small.empty = true;
  small.extent_m = 300.0;
  small.terrain_cell_m = 20.0;
  small.lat_deg = city.lat_deg;
  small.lon_deg = city.lon_deg;
  small.base_height_m = city.base_height_m;
  return scene::Scene(scene::make_city(small));
}

}  // namespace

namespace {

std::string key_of(const scene::SceneConfig& config) {
  scene::SceneConfig copy = config;
  return fields_as_json([&copy](FieldVisitor& f) { visit(f, copy); });
}

}  // namespace

Result<std::shared_ptr<const scene::Scene>> SceneCache::get(const scene::SceneConfig& config) {
  Made& slot = scenes_[key_of(config)];
  if (!slot.scene) {
    CANYON_TRY(scene::ImportedScene made, scene::make_scene(config));
    slot = {std::make_shared<scene::Scene>(std::move(made.parts)), std::move(made.report.warnings)};
  }
  return slot.scene;
}

std::vector<std::string> SceneCache::warnings(const scene::SceneConfig& config) const {
  const auto found = scenes_.find(key_of(config));
  return found == scenes_.end() ? std::vector<std::string>() : found->second.warnings;
}

Result<GpsTime> start_time(const MissionConfig& config) {
  const auto start = GpsTime::parse(config.time.start, "");
  if (start) return *start;
  Error error = start.error();
  error.key = "time.start";
  return error;
}

Result<PreparedMission> prepare(const MissionConfig& config, SceneCache& scenes) {
  PreparedMission mission;
  CANYON_TRY(mission.start, start_time(config));
  CANYON_TRY_STATUS(check_consistency(config));
  if (config.autonomy.waypoints.empty())
    return Error{.key = "autonomy.waypoint", .what = "no waypoints", .expected = "at least one [[autonomy.waypoint]]"};

  CANYON_TRY(mission.files, read_inputs(config));

  // Of the built-in city all this is known before its terrain is made, which may take a minute.
  const auto site = scene::planned_site(config.scene);
  if (site) {
    CANYON_TRY_STATUS(plan(config, *site, mission));
    CANYON_TRY_STATUS(check_sensors(config, mission, stand_in(config.scene.city)));
  }
  CANYON_TRY(mission.scene, scenes.get(config.scene));
  mission.warnings = scenes.warnings(config.scene);
  const scene::Scene& scene = *mission.scene;
  if (!site) {
    CANYON_TRY_STATUS(plan(config, scene::site_of(scene, config.scene), mission));
    CANYON_TRY_STATUS(check_sensors(config, mission, scene));
  }
  CANYON_TRY_STATUS(check_ground(config, scene));
  CANYON_TRY(mission.traffic, scene::Traffic::make(config.scene.moving, scene));
  CANYON_TRY_STATUS(check_start_is_free(config, mission));
  CANYON_TRY_STATUS(check_waypoints_are_free(config, mission));
  CANYON_TRY_STATUS(check_sight(config, mission.prior, scene));
  return mission;
}

}  // namespace canyon::mission
