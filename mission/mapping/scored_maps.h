#pragma once

#include <optional>
#include <vector>

#include "canyon/lidar/voxels/voxel_map.h"
#include "canyon/mission/boundaries.h"
#include "canyon/mission/config/mission_config.h"
#include "canyon/mission/mapping/mapper.h"
#include "canyon/mission/recorder/recorder.h"
#include "canyon/mission/recorder/run_record.h"

namespace canyon::mission {

/// The two maps of a run's keyframes that are scored at its end: with the filter's pose alone, and registered. Without
/// registration there is no second one; a map that nobody reads is not made.
class ScoredMaps {
 public:
  struct Wanted {
    bool by_filter = true, registered = true;
  };
  ScoredMaps(const RunConfig& config, Wanted wanted, PartClock& clock);

  /// `deskewed` in L at the keyframe's time.
  void add(const LidarScan& deskewed, const Keyframe& keyframe);
  /// Scores the maps, hands them over and lets them go, one after the other.
  Status finish(const scene::SceneAt& scene, const Boundaries& boundaries, RunRecord& record, Recorder& recorder);

 private:
  void add(const LidarScan& deskewed, const Pose& X_WL, lidar::VoxelMap& map);

  float range2_m2_;
  PartClock& clock_;
  std::optional<lidar::VoxelMap> prior_, registered_;
  std::vector<lidar::MapPoint> placed_;  // of one scan
  int keyframes_ = 0;
};

}  // namespace canyon::mission
