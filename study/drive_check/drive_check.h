#pragma once

#include <cstdint>
#include <string>

#include "canyon/core/output/json.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/study/drive_check/drive_figures.h"
#include "canyon/study/drive_check/drive_score.h"

namespace canyon::study {

/// A recorded drive and what it is compared with.
struct DriveCheckInputs {
  const gnss::RecordedData& data;              ///< the log, its navigation data and orbits
  const std::vector<StampedPlace>& reference;  ///< of the antenna
  std::string reference_name, scene_name;      ///< for messages
  const scene::Scene& scene;
  gnss::GnssConfig receiver;       ///< the one simulated; satellites as of the log's navigation files
  gnss::SinglePointConfig solver;  ///< that both are solved with
  std::uint64_t seed = 1;
  int draws = 1;  ///< of the simulation, each with the next seed and the next `clutter_street`
  double from_sow = 0.0, to_sow = 604800.0;
};

/// One drive as a receiver logged it, real or simulated.
struct DriveSide {
  std::vector<DriveEpoch> epochs;
  std::vector<DriveFix> fixes;
  DriveFigures figures;
  /// Simulated: of each draw, where there are several. Measured: of 200 block bootstraps (drive_resampling.h).
  std::vector<DriveFigures> spread;
};

struct DriveCheck {
  DriveSide simulated, measured;  ///< the first draw; the log
  DriveScore score;               ///< where there are several draws
  std::vector<std::string> warnings;
};

/// Simulates the receiver in the scene at the epochs of the log, along the reference, and measures both by the same
/// rules: signals (drive_signals.h), and fixes by the same solver at every instant of the reference. An Error where
/// the log has no epoch with a reference, or the city does not reach around all of them: the antenna must be within
/// the horizontal bounds of its buildings (without buildings, of the whole scene).
Result<DriveCheck> check_drive(const DriveCheckInputs& inputs);

/// What `canyon gnss drive-check` says: JSON, a table, and each signal over time as CSV.
Json drive_check_json(const DriveCheck& check);
std::string drive_check_text(const DriveCheck& check);
std::string drive_signals_csv(const DriveCheck& check);

}  // namespace canyon::study
