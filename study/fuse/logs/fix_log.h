#pragma once

#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/tables/state_table.h"
#include "canyon/study/fuse/config.h"

namespace canyon::study {

/// Fixes of a log; those that say that there was none are left out and counted.
struct FixLog {
  std::vector<GnssFix> fixes;
  std::vector<GpsTime> came;      ///< the same index: as StateRow::came
  std::vector<GnssEpoch> ranges;  ///< of RINEX observations, corrected; also of epochs without a fix
  bool has_week = false;
  Occurrences without_solution, withheld;
  PassedOver passed_over;
  std::vector<std::string> warnings;
};

/// A solution file (core/tables/state_table.h); with `navigation` RINEX observations, solved epoch by epoch. Sigmas
/// that the file does not state are those of `config`; an Error where neither does. Fixes may stand so late in it.
Result<FixLog> read_fix_log(const std::string& path, const std::vector<std::string>& navigation,
                            const FuseGnssConfig& config, double late_s);

}  // namespace canyon::study
