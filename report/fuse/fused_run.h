#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/report/read/epoch_table.h"
#include "canyon/report/read/filter_verdict.h"

namespace canyon::report {

/// Root mean square errors of one trajectory; NaN where the reference says nothing.
struct FusedFigures {
  std::string name = {};  ///< "filter", or a smoother's
  double rms_3d_m = std::nan(""), final_m = std::nan(""), nees = std::nan("");
  std::vector<double> position_enu_m, velocity_enu_m_s, attitude_deg;  ///< 3 numbers, or empty
  double outage_horizontal_m = std::nan(""), outage_vertical_m = std::nan("");
};

/// A stretch in which fixes were withheld; seconds from the start.
struct FusedOutage {
  double from_s = 0.0, to_s = 0.0, horizontal_max_m = std::nan(""), vertical_max_m = std::nan("");
};

struct FusedMeasurement {
  std::string name;
  double count = 0.0, accepted = 0.0;
  std::vector<double> t_s, nis;  ///< in the order of time
  int dimension = 0;
};

/// What `canyon fuse --out` has left in a directory (docs/fuse.md).
struct FusedRun {
  std::string start_from, imu, gnss, truth;
  std::vector<std::string> states, measurements;
  double duration_s = 0.0, samples = 0.0, fixes = 0.0, fixes_accepted = 0.0, fixes_withheld = 0.0, restarts = 0.0;
  std::vector<FusedFigures> trajectories;         ///< the filter's, and a smoother's if there is one
  std::vector<std::vector<FusedOutage>> outages;  ///< of each of them
  std::vector<std::optional<EpochTable>> errors;  ///< the same; t_s from the start
  std::vector<FusedMeasurement> innovations;
  FilterVerdict verdict;
  std::vector<std::string> mended;  ///< "3 x gap in the IMU's samples"
};

Result<FusedRun> read_fused_run(const std::string& directory);

}  // namespace canyon::report
