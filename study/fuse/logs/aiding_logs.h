#pragma once

#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/tables/passed_over.h"
#include "canyon/study/fuse/config.h"

namespace canyon::study {

/// Speeds or counts of a wheel: columns `t_s` (or gps_week, sow), `speed_m_s` (any unit of speed) or `ticks`, and
/// `dt_s` if they are not of the time since the line before.
struct OdometerLog {
  std::vector<OdometerSample> samples;
  bool has_week = false;
  PassedOver passed_over;
};
Result<OdometerLog> read_odometer_log(const std::string& path, const FuseOdometerConfig& config);

}  // namespace canyon::study
