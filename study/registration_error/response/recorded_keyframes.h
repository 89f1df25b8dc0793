#pragma once

#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/core/motion/true_motion.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::study {

/// What a mapper was given at one keyframe, but for the poses: whoever replays it says where the scan was.
struct RecordedKeyframe {
  GpsTime t;
  Pose X_WB_true;
  double distance_m = 0.0;     ///< driven since the start
  LidarScan scan;              ///< deskewed, in L
  Matrix6d pose_covariance;    ///< that the filter claimed
  Matrix6d motion_covariance;  ///< of its prediction since the keyframe before
};

/// The keyframes of one run on a tape.
struct RecordedKeyframes {
  GpsTime start;
  TrueMotion motion;
  std::vector<RecordedKeyframe> keyframes;
  double cpu_s = 0.0;
};
/// Drives it once with the mission's sensors and filter. Where its registration is off it is done with method "gicp":
/// the filter predicts motions for alignments alone.
Result<RecordedKeyframes> record_keyframes(const mission::MissionConfig& config,
                                           const mission::PreparedMission& mission, const Tape& tape);

/// A stretch of the route: keyframes [begin, end), and the ones before it that a map is begun with.
struct Stretch {
  std::size_t first = 0, begin = 0, end = 0;
  double from_m = 0.0;
};
/// Stretches of that length along the route, from where `lead` keyframes lie behind on; without those that have fewer
/// than kFewestInStretch keyframes.
inline constexpr std::size_t kFewestInStretch = 5;
std::vector<Stretch> stretches(const RecordedKeyframes& recorded, double length_m, std::size_t lead);

}  // namespace canyon::study
