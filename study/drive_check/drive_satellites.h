#pragma once

#include <vector>

#include "canyon/core/output/json.h"
#include "canyon/study/drive_check/drive_signals.h"

namespace canyon::study {

/// Each satellite over time, by its name ("G12"), on either side of a drive: columns sow (s of the GPS week), in_sight,
/// elevation_deg, azimuth_deg, cn0_dbhz, error_m and rate_error_m_s, to three decimals, one value per epoch in which it
/// was tracked; null where it is not known. Those of neither side are not there.
Json drive_satellites_json(const std::vector<DriveEpoch>& simulated, const std::vector<DriveEpoch>& measured);

}  // namespace canyon::study
