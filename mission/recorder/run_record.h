#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/messages.h"
#include "canyon/core/motion/tape.h"
#include "canyon/core/truth.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/lidar/files/cloud_files.h"
#include "canyon/lidar/map_quality.h"
#include "canyon/mission/autonomy/autonomy.h"
#include "canyon/mission/config/mission_config.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/part_clock.h"
#include "canyon/mission/scoring/scorer.h"

namespace canyon::mission {

/// One row per [run] epoch_rate_hz.
struct NavRow {
  GpsTime t;
  Pose X_WB_true;
  double true_speed_m_s = 0.0;
  NavEstimate estimate;
  DriveCommand command;
  int waypoint = 0;  ///< 1-based number of the waypoint the autonomy heads for
  AutonomyState state = AutonomyState::kBlind;
};

/// One row per due GNSS epoch.
struct GnssRow {
  GnssFix fix;
  GnssTruth truth;
  std::vector<double> cn0_dbhz;  ///< by satellite of the truth record; NaN where not tracked
  Eigen::Vector3d p_A_W_true = Eigen::Vector3d::Zero();
  bool withheld = false;
  fusion::UpdateReport update;
};

/// One row per keyframe.
struct KeyframeRow {
  GpsTime t;
  std::size_t points = 0;
  Pose X_WL_true, X_WL_prior, X_WL_registered;
  std::optional<lidar::RegistrationStatus> status;  ///< none: not registered
  int iterations = 0;
  double rms_m = kNaN;
};

/// All that one run leaves behind; results and reports are made from it.
struct RunRecord {
  std::string name;       ///< file name of the run: "low", "high_gnss_low_imu"
  std::string gnss, imu;  ///< whose fidelity each comes from
  MissionConfig config;
  std::vector<InputFile> files;  ///< that it read

  LocalFrame frame;
  GpsTime start;
  bool open_loop = false;  ///< on a tape: no outcome, no waypoints
  double simulated_s = 0.0;
  double distance_m = 0.0;
  std::string outcome;
  std::optional<Failure> failure;
  std::vector<WaypointScore> waypoints;

  std::vector<TapeNode> tape;  ///< empty but for the start with [run] record_tape = false
  std::vector<NavRow> nav;
  std::vector<GnssRow> gnss_rows;
  std::vector<KeyframeRow> keyframes;
  std::vector<lidar::MapPoint> prior_map, registered_map;
  lidar::MapQuality prior_quality, registered_quality;

  std::vector<std::string> warnings;  ///< about inputs, for example damaged records that were skipped
  std::map<std::string, std::int64_t> counters;
  PartClock clock;
  double wall_s = 0.0;

  /// False with [registration] method "none": nothing is then known of registered keyframes and of their map.
  bool registers() const { return config.registration.method != "none"; }

  /// False for a GNSS model that makes fixes without satellites: counts of satellites and DOP jumps are then undefined.
  bool forms_pseudoranges() const {
    return std::any_of(gnss_rows.begin(), gnss_rows.end(),
                       [](const GnssRow& row) { return !row.truth.satellites.empty(); });
  }
};

}  // namespace canyon::mission
