#pragma once

#include "canyon/core/result.h"
#include "canyon/mission/config/mission_config.h"

namespace canyon::mission {

/// That no two keys, each within its own range, contradict one another: rates that do not divide the IMU's, stops that
/// the autonomy does not make or that do not count where it makes them, a way back that comes after the end, a vehicle
/// that does not fit into its own body, an autonomy that asks of the vehicle what it cannot do, works with poses that
/// nobody registers, or has a least above its most. Errors name all the keys concerned.
Status check_consistency(const MissionConfig& config);

}  // namespace canyon::mission
