#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/recorder/recorder.h"
#include "canyon/mission/run.h"

namespace canyon::mission {

/// What a run does that can be told from outside, in its order.
enum class Heard { kImu, kOdometer, kBarometer, kMagnetometer, kFix, kSeen, kCounted, kAsked, kEpoch };
struct HeardEvent {
  Heard what;
  GpsTime t;
};

/// A run whose autonomy does as it is told by the case, and writes down what it is shown and asked.
struct HeardRun {
  /// What it answers.
  struct Says {
    std::function<DriveCommand(int)> drives{};  ///< the so many-th question
    std::function<AutonomyState(int)> is{};     ///< after so many questions; empty: it drives
    bool looks = true;
    int next_waypoint = 0;
  };

  MissionConfig config;
  PreparedMission mission;
  RunRecord record;
  std::vector<HeardEvent> events;
  std::vector<NavEstimate> asked, seen;  ///< estimates that came with them
  std::vector<DriveCommand> given;       ///< an answer to each question
  std::vector<Pose> seen_from;
  std::vector<LidarScan> scans;
  std::vector<NavRow> rows;
  std::vector<GnssRow> fixes;
  std::vector<TapeNode> nodes;
};

/// Up the open street (open_street.h) at low fidelity with these keys besides; on `tape` where there is one.
std::unique_ptr<HeardRun> heard_run(const std::string& keys, const HeardRun::Says& says, const Tape* tape = nullptr,
                                    const Omissions* omissions = nullptr);

}  // namespace canyon::mission
