#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/fusion/verdict/verdict.h"
#include "canyon/lidar/map_quality/map_error.h"
#include "canyon/mission/config/mission_config.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/part_clock.h"
#include "canyon/mission/scoring/scorer.h"

namespace canyon::mission {

/// What is known of one run when it has ended, however long it was; what it gave on the way went to a Recorder.
struct RunRecord {
  std::string name;       ///< file name of the run: "low", "high_gnss_low_imu"
  std::string gnss, imu;  ///< whose fidelity each comes from
  std::string filter;     ///< named for this run beside it; empty: the fidelity's own
  MissionConfig config;
  std::vector<InputFile> files;  ///< that it read

  LocalFrame frame;
  GpsTime start;
  bool open_loop = false;  ///< on a tape: no outcome, no waypoints
  bool maps_made = true;   ///< and scored; not where a plan left them out
  bool keyframes_made = true;
  double simulated_s = 0.0;
  double distance_m = 0.0;
  std::optional<Outcome> outcome;  ///< none in an open loop
  std::optional<Failure> failure;
  std::vector<WaypointScore> waypoints;
  Encounters::Numbers encounters;    ///< nothing in an open loop
  int needless_lane_departures = 0;  ///< the same

  Pose initial_X_WB;  ///< what the filter started from
  Eigen::Vector3d initial_v_WB_W = Eigen::Vector3d::Zero();
  Eigen::Quaterniond imu_R_BU = Eigen::Quaterniond::Identity();  ///< true axes of the IMU, which the filter is not told
  lidar::MapQuality prior_quality, registered_quality;

  fusion::VerdictNumbers verdict;  ///< on its filter

  std::vector<std::string> warnings;  ///< about inputs, for example damaged records that were skipped
  std::map<std::string, std::int64_t> counters;
  PartClock clock;
  double wall_s = 0.0;

  bool registers() const { return lidar::registers(config.registration); }
};

}  // namespace canyon::mission
