#pragma once

#include <memory>
#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/core/result.h"
#include "canyon/mission/autonomy/autonomy.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::study {

/// What the models of a fidelity do to what an autonomy sees and plans, on a given true motion.
struct SeenAndPlanned {
  double phantom_share = kNaN;     ///< directions ahead in which something is held to block, and nothing is near there
  double missed_share = kNaN;      ///< in which something stands, and nothing is held to block
  double range_rms_m = kNaN;       ///< to the first thing, as held and as it is, where there is one in both
  double steering_rms_deg = kNaN;  ///< what the autonomy asks for, against what it asks for with the true pose
  double speed_rms_m_s = kNaN;
};

/// Drives the configuration on the tape twice, with its estimate and with the true pose, on the same draws. Obstacles
/// are those of the autonomy's perception (`ground_grid` where it has none) in a grid in W, where the pose puts each
/// scan; looked at once a second, in directions 2 degrees apart up to 40 degrees to both sides, up to 20 m. Truth is
/// the nearest of the scene's surfaces but the ground at three heights of a body.
Result<SeenAndPlanned> seen_and_planned(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                        const Tape& tape);

}  // namespace canyon::study
