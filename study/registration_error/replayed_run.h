#pragma once

#include <array>

#include "canyon/core/files/tape.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/study/registration_error/fix_store.h"
#include "canyon/study/registration_error/scan_store.h"

namespace canyon::study {

/// A mean square error of a run.
struct MeanSquare {
  const char* key;
  const char* unit;
};
inline constexpr std::array<MeanSquare, 9> kMeanSquares{{{"map", "m2"},
                                                         {"height", "m2"},
                                                         {"keyframe", "m2"},
                                                         {"keyframe_east", "m2"},
                                                         {"keyframe_north", "m2"},
                                                         {"keyframe_up", "m2"},
                                                         {"keyframe_roll", "deg2"},
                                                         {"keyframe_pitch", "deg2"},
                                                         {"keyframe_yaw", "deg2"}}};

struct ReplayedRun {
  std::array<double, kMeanSquares.size()> mean_square{};  ///< in their order; NaN where there is nothing to measure
  double cpu_s = 0.0;
};

/// What replays of one seed on one tape need not make twice.
struct ReplayStores {
  FixStore fixes;
  ScanStore scans;
};

/// Who replays. It changes nothing but the cost.
enum class Replay {
  kPlain,   ///< a run as it is by itself: with its autonomy, both maps, scans and clouds of its own
  kThrifty  ///< nobody drives, only the map that is judged is made, scans and clouds come from the store
};

/// One run on the tape, of whose maps and keyframes the errors are kept.
Result<ReplayedRun> replay_run(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                               const Tape& tape, ReplayStores& stores, Replay replay);

}  // namespace canyon::study
