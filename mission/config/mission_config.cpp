#include "canyon/mission/config/mission_config.h"

#include <algorithm>

#include "canyon/inertial/imu_model.h"
#include "canyon/mission/autonomy/reference.h"

namespace canyon::mission {

void visit(FieldVisitor& f, TimeConfig& c) {
  f.text("start", c.start, "first instant: ISO date (GPS time, or UTC with Z) or WEEK:SOW");
  f.number("limit_s", c.limit_s, {0, 1e5}, "ends the run after this time at the latest; 0 = no such limit");
}

void visit(FieldVisitor& f, SuccessConfig& c) {
  f.number("waypoint_radius_m", c.waypoint_radius_m, {0.1, 100}, "how near the true vehicle must come to a waypoint");
  f.number("stop_s", c.stop_s, {0, 600}, "how long it must stand at a mission waypoint");
  f.number("stopped_speed_m_s", c.stopped_speed_m_s, {0.001, 1}, "slower than this counts as standing");
  f.number("facade_share", c.facade_share, {0, 1}, "share of a 5 x 5 grid on the facade that must be in sight");
  f.number("camera_height_m", c.camera_height_m, {0, 10}, "of the camera above B");
  f.number("limit_factor", c.limit_factor, {1, 100}, "time limit as a multiple of the nominal time");
  f.number("stuck_after_s", c.stuck_after_s, {5, 1e4}, "standing still this long without observing ends the run");
  f.number("camera_px_per_rad", c.camera_px_per_rad, {10, 1e5}, "of the camera, in the middle of its picture");
  visit_choice(f, "collision", c.collision, "what of the body is held against the scene");
  f.number("near_miss_m", c.near_miss_m, {0, 3}, "something that comes nearer to the true body is a near miss");
  f.number("phantom_free_m", c.phantom_free_m, {0.5, 50},
           "an autonomy that finds no way with so much truly free ahead of the body has seen a phantom");
}

void visit(FieldVisitor& f, RunConfig& c) {
  f.text("name", c.name, "name of the mission");
  f.integer("seed", c.seed, {0, 9e15}, "of every random stream of the run");
  f.vector3("initial_attitude_error_deg", c.initial_attitude_error_deg, {0, 180},
            "1-sigma of the seeded initial roll, pitch and heading error");
  f.number("map_leaf_m", c.map_leaf_m, {0.02, 10}, "one scored map point per voxel of this size");
  f.number("map_range_m", c.map_range_m, {1, 1000}, "returns beyond are not mapped");
  f.number("epoch_rate_hz", c.epoch_rate_hz, {0.01, 100}, "rows of epochs/RUN_nav.csv per second");
  f.flag("record_tape", c.record_tape, "keeps the true motion as tapes/RUN.tape, for open loops");
  f.flag("record_filter_input", c.record_filter_input,
         "keeps what sensors tell the filter, fixes with full covariances, as epochs/RUN_imu.csv, RUN_fixes.csv and "
         "others, for other filters");
  f.flag("record_covariance", c.record_covariance,
         "keeps the full covariance of position, velocity and attitude at the rows of epochs/RUN_nav.csv, as "
         "epochs/RUN_nav_covariance.csv: some 35 MB an hour");
  f.flag("truth_as_height", c.truth_as_height, "the height of the pose that is handed on is the true one");
  f.flag("truth_as_pose", c.truth_as_pose, "cuts the filter out: autonomy, deskewing and map get the true pose");
  f.flag("truth_as_guess", c.truth_as_guess,
         "registration begins from the true motion since the last keyframe, not from the filter's");
  f.number("estimate_up_offset_m", c.estimate_up_offset_m, {-100, 100}, "added to the height of the estimate");
  f.number("told_step_m", c.told.step_m, {0, 1000},
           "the autonomy is told a place that is so far off, first after told_step_every_s");
  f.number("told_step_every_s", c.told.step_every_s, {0.1, 1e5}, "after so long in another direction");
  f.number("told_drift_m_s", c.told.drift_m_s, {0, 100},
           "the place that the autonomy is told moves off at this speed, in one direction");
  f.number("told_heading_deg", c.told.heading_deg, {-180, 180},
           "the autonomy is told a heading that is so far off, clockwise");
  f.optional_number("withhold_fixes_after_s", c.withhold_fixes_after_s, -1, {0, 1e5},
                    "no fix reaches the filter from then on; -1 = never");
  f.optional_number("withhold_scans_after_s", c.withhold_scans_after_s, -1, {0, 1e5},
                    "no scan reaches map and autonomy from then on; -1 = never");
}

void visit(FieldVisitor& f, MissionConfig& c) {
  f.group("scene", c.scene, "the built-in city, or a scene from files");
  f.group("time", c.time, "start, and an early end");
  f.group("vehicle", c.vehicle, "the ground vehicle");
  f.group("gnss", c.gnss, "the GNSS receiver and its errors");
  f.group("imu", c.imu, "the inertial sensor and its errors");
  f.group("odometer", c.odometer,
          "the wheel's encoder, where the filter measures with one or the autonomy goes or checks itself by it");
  f.group("barometer", c.barometer, "static pressure at the IMU, where the filter measures with it");
  f.group("magnetometer", c.magnetometer, "the Earth's field along the IMU's axes, where the filter measures with it");
  f.group("lidar", c.lidar, "the LIDAR");
  f.group("fusion", c.fusion, "the localization filter");
  f.group("registration", c.registration, "registration of keyframes");
  f.group("autonomy", c.autonomy, "who drives, and where to");
  f.group("success", c.success, "what the mission is scored by");
  f.group("run", c.run, "seed, map and deliberate cuts");
}

AidingSensors sensors_for(const std::vector<std::string>& measurements) {
  const auto has = [&measurements](const char* row) {
    return std::find(measurements.begin(), measurements.end(), row) != measurements.end();
  };
  return {.odometer = has("odometer"), .barometer = has("barometer"), .magnetometer = has("magnetometer")};
}

AidingSensors aiding_sensors(const MissionConfig& config) {
  AidingSensors sensors = sensors_for(fusion::filter_parts(config.fusion).measurements);
  sensors.odometer = sensors.odometer || counts_wheel(config.autonomy);
  return sensors;
}

bool takes_registered_poses(const MissionConfig& config) {
  return config.autonomy.map == MapPose::kRegistered || fusion::measures_with(config.fusion, "relative_pose") ||
         fusion::measures_with(config.fusion, "map_pose");
}

Result<ImuNoise> noise_told_to_filter(const MissionConfig& config) {
  if (config.fusion.imu.empty()) return inertial::datasheet_noise(config.imu);
  auto noise = inertial::catalogue_noise(config.fusion.imu);
  if (noise) return noise;
  Error error = noise.error();
  if (error.key == "imu.sensor") error.key = "fusion.imu";
  return error;
}

}  // namespace canyon::mission
