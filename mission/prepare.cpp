#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/check.h"
#include "core/config_text.h"
#include "core/files.h"
#include "mission/mission_file.h"

namespace canyon::mission {

namespace {

std::string place(const Eigen::Vector2d& p) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.1f, %.1f)", p.x(), p.y());
  return text;
}

/// A point where a vehicle can stand: on the terrain, outside buildings. `who` is to stand there.
Status check_standing_place(const scene::Scene& scene, const Eigen::Vector2d& p, const std::string& key,
                            const std::string& who) {
  const auto& extent = scene.extent();
  if (!scene.ground(p.x(), p.y()))
    return Error{.key = key,
                 .what = who + place(p) + " lies outside the scene",
                 .expected = "x from " + number_text(extent.min.x()) + " to " + number_text(extent.max.x()) +
                             ", y from " + number_text(extent.min.y()) + " to " + number_text(extent.max.y())};
  if (const scene::Building* building = scene.building_at(p))
    return Error{
        .key = key, .what = who + place(p) + " lies inside " + building->name, .expected = "a place outside buildings"};
  return Ok{};
}

/// `sensor` is the section whose rate the IMU's has to be a multiple of.
Status check_rate(double imu_hz, double rate_hz, const std::string& sensor) {
  const double ratio = imu_hz / rate_hz;
  if (std::abs(ratio - std::round(ratio)) > 1e-9)
    return Error{
        .key = sensor + ".rate_hz, imu.rate_hz",
        .what = "the IMU's " + number_text(imu_hz) + " Hz are not a multiple of " + number_text(rate_hz) + " Hz",
        .expected = "imu.rate_hz to be a whole number times " + sensor + ".rate_hz"};
  return Ok{};
}

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

}  // namespace

Result<std::shared_ptr<const scene::Scene>> SceneCache::get(const scene::SceneConfig& config) {
  scene::SceneConfig copy = config;
  auto& slot = scenes_[fields_as_json([&copy](FieldVisitor& f) { visit(f, copy); })];
  if (!slot) {
    CANYON_TRY(scene::ImportedScene made, scene::make_scene(config));
    slot = std::make_shared<scene::Scene>(std::move(made.parts));
  }
  return slot;
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
  CANYON_TRY_STATUS(check_rate(config.imu.rate_hz, config.gnss.rate_hz, "gnss"));
  CANYON_TRY_STATUS(check_rate(config.imu.rate_hz, config.lidar.rate_hz, "lidar"));
  CANYON_TRY_STATUS(check_stop(config.success.stop_s, config.autonomy));
  if (config.autonomy.waypoints.empty())
    return Error{.key = "autonomy.waypoint", .what = "no waypoints", .expected = "at least one [[autonomy.waypoint]]"};

  CANYON_TRY(mission.files, read_inputs(config));

  CANYON_TRY(mission.scene, scenes.get(config.scene));
  const scene::Scene& scene = *mission.scene;
  CANYON_TRY_STATUS(check_standing_place(scene, config.vehicle.start_m, "vehicle.start_m", ""));
  for (std::size_t i = 0; i < config.autonomy.waypoints.size(); ++i) {
    const Waypoint& waypoint = config.autonomy.waypoints[i];
    const std::string key = "autonomy.waypoint[" + std::to_string(i + 1) + "]";
    CANYON_TRY_STATUS(check_standing_place(scene, waypoint.p_m, key, "waypoint \"" + waypoint.name + "\" at "));
    if (!waypoint.is_mission() || config.scene.city.empty) continue;
    std::vector<std::string> names;
    for (const auto& building : scene.buildings()) names.push_back(building.name);
    if (std::find(names.begin(), names.end(), waypoint.observe) == names.end())
      return Error{.key = key,
                   .what = "waypoint \"" + waypoint.name + "\": no building named \"" + waypoint.observe + "\"",
                   .expected = "a building of the scene; nearest is \"" + nearest_word(waypoint.observe, names) + "\""};
  }

  CANYON_TRY(mission.traffic, scene::Traffic::make(config.scene.moving, scene));
  CANYON_TRY(mission.prior, plan_route(config.autonomy, scene.streets(), config.vehicle.start_m));
  std::vector<double> stops{mission.prior.route.length_m()};
  double holds_s = 0.0;
  for (std::size_t i = 0; i < config.autonomy.waypoints.size(); ++i) {
    if (!config.autonomy.waypoints[i].is_mission()) continue;
    stops.push_back(mission.prior.waypoint_s_m[i]);
    holds_s += config.autonomy.hold_s;
  }
  mission.nominal_s =
      holds_s + nominal_drive_time_s(mission.prior.route,
                                     {config.autonomy.cruise_m_s, config.autonomy.lateral_m_s2,
                                      config.vehicle.max_acceleration_m_s2, config.autonomy.braking_m_s2},
                                     stops);
  mission.time_limit_s = config.success.limit_factor * mission.nominal_s;
  if (config.time.limit_s > 0.0) mission.time_limit_s = std::min(mission.time_limit_s, config.time.limit_s);
  return mission;
}

Status check_sensors(const MissionConfig& config, const PreparedMission& mission) {
  const auto seed = static_cast<std::uint64_t>(config.run.seed);
  const GpsTime end = mission.start + mission.time_limit_s;
  CANYON_TRY_STATUS(gnss::make_gnss_sensor(config.gnss, seed, mission.start, end, *mission.scene));
  CANYON_TRY_STATUS(inertial::make_imu(config.imu, seed, mission.scene->frame()));
  CANYON_TRY_STATUS(lidar::make_scanner(config.lidar, seed));
  CANYON_TRY_STATUS(lidar::make_registration(config.registration));
  return Ok{};
}

}  // namespace canyon::mission
