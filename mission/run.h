#pragma once

#include <memory>

#include "core/progress.h"
#include "core/result.h"
#include "mission/mission_file.h"
#include "mission/run_record.h"

namespace canyon::mission {

/// Drives one mission. The master step is the IMU period; at equal times the order is vehicle, IMU, GNSS, LIDAR,
/// autonomy. The only loop is estimate -> drive: truth goes to sensors and scorer alone.
///
/// Errors only for what the user can mend (a navigation file that cannot be read), and, with exit status 1, where a
/// part gives what is not finite (mission/boundaries.h); a failed mission is a result. Throws Cancelled after Ctrl-C.
/// `progress` (may be null) advances by simulated seconds. `autonomy` drives in place of the configured one.
Result<RunRecord> run_mission(const MissionConfig& config, const PreparedMission& mission, Progress* progress = nullptr,
                              std::unique_ptr<Autonomy> autonomy = nullptr);

}  // namespace canyon::mission
