#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "canyon/core/process/ordered_work.h"
#include "canyon/mission/boundaries.h"
#include "canyon/mission/mapping/mapper.h"
#include "canyon/mission/mapping/scored_maps.h"
#include "canyon/mission/part_clock.h"
#include "canyon/mission/recorder/recorder.h"

namespace canyon::mission {

/// A run's keyframes: placed, put into its maps, handed to its recorder. Unless something in the loop reads where they
/// were placed, that is done beside the loop (core/process/ordered_work.h), with the same result.
class Keyframes {
 public:
  struct Scan {
    std::shared_ptr<const LidarScan> deskewed;  ///< in L at its stamp
    NavEstimate estimate;
    RelativePose motion;  ///< of B since the keyframe before, by prediction alone
    Pose X_WB_true;
    double distance_m = 0.0;  ///< truly driven by then
  };
  /// All that is given by reference outlives it. `recorder` is asked by the thread of take() and finish() alone.
  Keyframes(const MissionConfig& config, std::unique_ptr<lidar::Registration> registration,
            std::shared_ptr<const lidar::PreparedCloud> prior_map, ScoredMaps::Wanted maps,
            const Boundaries& boundaries, PartClock& clock, Recorder& recorder);

  /// Whether a scan there would become a keyframe, if it has returns.
  bool wants(const NavEstimate& estimate) const { return mapper_.wants(estimate); }
  /// The scan becomes one.
  Status take(Scan scan);
  /// Until all that were taken are placed and recorded.
  Status complete();
  /// After complete(): scores the maps and hands them over.
  Status score_maps(const scene::SceneAt& scene, RunRecord& record);

  /// Of a run whose loop reads them: the last one, and as of Mapper.
  const Keyframe& last() const;
  const Pose& correction() const;
  /// After complete().
  const Mapper::Counters& counters() const { return mapper_.counters(); }

 private:
  /// A scan that has been placed, or why it could not be.
  struct Placed {
    Scan scan;
    Result<KeyframeRow> row;
  };
  void place(const Scan& scan, const Pose& X_LL_true);
  Result<KeyframeRow> placed_row(const Scan& scan, const Pose& X_LL_true);
  /// What has been placed meanwhile, to the recorder.
  Status hand_on();

  const Pose X_BL_;
  const bool at_once_;
  const Boundaries& boundaries_;
  PartClock& clock_;
  Recorder& recorder_;
  Pose last_X_WL_true_;
  Mapper mapper_;
  ScoredMaps maps_;
  Keyframe last_;
  std::mutex mutex_;
  std::vector<Placed> placed_;
  OrderedWork work_;  // last: it ends before what it works on
};

}  // namespace canyon::mission
