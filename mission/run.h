#pragma once

#include "core/progress.h"
#include "core/result.h"
#include "mission/mission_file.h"
#include "mission/run_record.h"

namespace canyon::mission {

/// Drives one mission. The master step is the IMU period; at equal times the order is vehicle, IMU, GNSS, LIDAR,
/// autonomy. The only loop is estimate -> drive: truth goes to sensors and scorer alone.
///
/// Errors only for what the user can mend (a navigation file that cannot be read); a failed mission is a result.
/// Throws Cancelled after Ctrl-C. `progress` (may be null) advances by simulated seconds.
Result<RunRecord> run_mission(const MissionConfig& config, const PreparedMission& mission,
                              Progress* progress = nullptr);

}  // namespace canyon::mission
