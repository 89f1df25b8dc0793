#pragma once

#include <optional>
#include <string>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/core/imu_noise.h"
#include "canyon/core/result.h"
#include "canyon/fusion/filter_config.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/inertial/aiding/barometer.h"
#include "canyon/inertial/aiding/magnetometer.h"
#include "canyon/inertial/aiding/odometer.h"
#include "canyon/inertial/imu_config.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/lidar/registration/registration.h"
#include "canyon/mission/autonomy/autonomy.h"
#include "canyon/mission/collision/collision.h"
#include "canyon/mission/motion/vehicle_config.h"
#include "canyon/scene/scene_source.h"

namespace canyon::mission {

/// [time]
struct TimeConfig {
  std::string start = "2010-11-17T13:00:00";  ///< the paper's field test
  double limit_s = 0.0;                       ///< if > 0: ends the run after this time at the latest (short tests)
};
void visit(FieldVisitor& f, TimeConfig& c);

/// [success]: what the mission is scored by, on truth.
struct SuccessConfig {
  double waypoint_radius_m = 3.0;
  double stop_s = 5.0;
  double stopped_speed_m_s = 0.1;
  double facade_share = 0.5;     ///< of a 5 x 5 grid on the building's façade that must be in sight
  double camera_height_m = 1.5;  ///< above B
  double limit_factor = 1.5;     ///< time limit as a multiple of the nominal time
  double stuck_after_s = 90.0;   ///< standing still this long without observing ends the run
  double camera_px_per_rad = 1000.0;
  double near_miss_m = 0.3;     ///< what comes nearer to the true body is a near miss
  double phantom_free_m = 5.0;  ///< who finds no way with so much truly free ahead has seen a phantom
  ModelChoice<collision_checks> collision{"box"};
};
void visit(FieldVisitor& f, SuccessConfig& c);

/// Errors that are laid over the pose which the autonomy is told; filter, map and what is recorded know nothing of
/// them.
struct ToldErrors {
  double step_m = 0.0;  ///< its place is so far off, in a direction of its own after every step_every_s
  double step_every_s = 20.0;
  double drift_m_s = 0.0;  ///< its place moves off at this speed, in one direction
  double heading_deg = 0.0;
};

/// [run]
struct RunConfig {
  std::string name = "mission";
  std::int64_t seed = 1;
  /// 1-sigma of the seeded error of the initial attitude: roll, pitch, heading.
  Eigen::Vector3d initial_attitude_error_deg{0.1, 0.1, 1.0};
  double map_leaf_m = 0.25;          ///< one scored map point per voxel of this size
  double map_range_m = 40.0;         ///< returns beyond are not mapped
  double epoch_rate_hz = 10.0;       ///< rows of epochs/RUN_nav.csv per second
  bool record_tape = true;           ///< keeps the true motion, so that other models can be driven on it
  bool record_filter_input = false;  ///< keeps what the filter was given: at 100 Hz some 55 MB an hour
  bool record_covariance = false;    ///< keeps the estimates' covariances: at 10 Hz some 35 MB an hour
  // Couplings that a study may cut on purpose.
  bool truth_as_height = false;                  ///< hands the true height on with the rest of the estimate
  bool truth_as_pose = false;                    ///< hands the true pose on; what is recorded stays the filter's
  bool truth_as_guess = false;                   ///< alignments begin from the true motion between keyframes
  double estimate_up_offset_m = 0.0;             ///< added to the estimate's height
  ToldErrors told;                               ///< of the pose, as the autonomy is told it
  std::optional<double> withhold_fixes_after_s;  ///< no fix reaches the filter from then on
  std::optional<double> withhold_scans_after_s;  ///< no scan reaches map and autonomy from then on
};
void visit(FieldVisitor& f, RunConfig& c);

/// Everything one run needs, resolved. The sections of a mission file in their order.
struct MissionConfig {
  scene::SceneConfig scene;
  TimeConfig time;
  VehicleConfig vehicle;
  gnss::GnssConfig gnss;
  inertial::ImuConfig imu;
  inertial::OdometerConfig odometer;
  inertial::BarometerConfig barometer;
  inertial::MagnetometerConfig magnetometer;
  lidar::LidarConfig lidar;
  fusion::FilterConfig fusion;
  lidar::RegistrationConfig registration;
  AutonomyConfig autonomy;
  SuccessConfig success;
  RunConfig run;
};
void visit(FieldVisitor& f, MissionConfig& c);

/// The sensors beside IMU and receiver: a run has those that its filter measures with.
struct AidingSensors {
  bool odometer = false, barometer = false, magnetometer = false;
};
/// What these rows of fusion/measurements take: each sensor has the name of its row.
AidingSensors sensors_for(const std::vector<std::string>& measurements);
AidingSensors aiding_sensors(const MissionConfig& config);
/// Whether autonomy or filter work with the poses that registration gives.
bool takes_registered_poses(const MissionConfig& config);
/// What the filter is told of the IMU: a datasheet ([fusion] imu), never what the simulated unit really does.
Result<ImuNoise> noise_told_to_filter(const MissionConfig& config);

}  // namespace canyon::mission
