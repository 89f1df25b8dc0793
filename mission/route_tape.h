#pragma once

#include "canyon/core/files/tape.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::mission {

/// The mission's own route as a tape: the mission's vehicle is driven along it on truth, with its stops, by a follower
/// that keeps to the centre line and meets no traffic. An Error with exit status 1 says where it cannot be driven:
/// something stands on the line, or the vehicle cannot turn that tightly.
Result<Tape> drive_route(const MissionConfig& config, const PreparedMission& mission);

/// A tape as it may be laid into this mission: recorded in the same scene with the same traffic (if in any), on the
/// scene's terrain from end to end, and as long as [time] limit_s asks for.
Status check_tape(const Tape& tape, const std::string& path, const MissionConfig& config,
                  const PreparedMission& mission);

/// A tape of a trajectory file: poses of B in the scene's frame W (.tum, .kitti with `rate_hz`, .csv), or a reference
/// solution in geodetic coordinates (.csv, KF-GINS text), joined by a quintic spline (inertial/motion/pose_spline.h).
/// Its times count from its first pose.
Result<Tape> tape_from_trajectory(const std::string& path, double rate_hz, const LocalFrame& frame);

/// [[scene.moving]] as JSON, as tapes record it.
std::string traffic_text(const MissionConfig& config);

}  // namespace canyon::mission
