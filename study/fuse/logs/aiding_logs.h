#pragma once

#include <string>
#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/messages.h"
#include "canyon/core/tables/passed_over.h"
#include "canyon/study/fuse/config.h"

namespace canyon::study {

/// Speeds or counts of a wheel: columns `t_s` (or gps_week, sow), `speed_m_s` (any unit of speed) or `ticks`, and
/// `dt_s` if they are not of the time since the line before.
struct OdometerLog {
  std::vector<OdometerSample> samples;
  bool has_week = false;
  PassedOver passed_over;
};
Result<OdometerLog> read_odometer_log(const std::string& path, const FuseOdometerConfig& config);

/// Headings of two antennas in a row: columns `t_s` (or gps_week, sow), `heading_deg` from true north, clockwise, and
/// its 1-sigma `sigma_deg`; without one that of `config`, an Error where neither says it.
struct HeadingLog {
  std::vector<HeadingSample> samples;
  bool has_week = false;
  PassedOver passed_over;
};
Result<HeadingLog> read_heading_log(const std::string& path, const FuseHeadingConfig& config);

/// Pose of B in E, as registration against a prior map gives it; covariance of [rotation; translation], right
/// perturbation, in B.
struct StampedMapPose {
  GpsTime t;
  Pose X_EB;
  Matrix6d covariance;
};
/// The message of it to a filter whose W is `frame`.
PoseInMap pose_in_frame(const StampedMapPose& pose, const LocalFrame& frame);

/// Poses in a map whose place on the Earth is known: a solution file (core/tables/state_table.h) that has places of B's
/// origin with their 1-sigmas, and attitudes with `sd_roll`, `sd_pitch`, `sd_yaw`. What is not stated is that of
/// `config`; an Error where neither says it, for a line without an attitude, and for local places without an origin.
struct PoseLog {
  std::vector<StampedMapPose> poses;
  bool has_week = false;
  PassedOver passed_over;
};
Result<PoseLog> read_pose_log(const std::string& path, const FusePosesConfig& config);

}  // namespace canyon::study
