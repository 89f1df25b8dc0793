#pragma once

#include <cstdint>

#include "canyon/core/files/ascii_grid.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/result.h"
#include "canyon/gnss/sensor/gnss_config.h"

namespace canyon::study {

struct GnssMapConfig {
  gnss::GnssConfig gnss;
  std::uint64_t seed = 1;
  GpsTime start;
  int epochs = 1;
  double step_s = 600.0;  ///< between epochs
  double cell_m = 2.0;
  double height_m = 1.5;  ///< of the antenna above the ground
};

/// What a receiver standing in the middle of each cell gets, over all epochs. Cells inside a building or off the
/// terrain have no value.
struct GnssMap {
  Grid visible;             ///< satellites above the mask in direct sight, mean
  Grid gdop;                ///< median over the epochs with a fix
  Grid error_horizontal_m;  ///< RMS over the epochs with a fix
  Grid error_up_m;          ///< likewise
  Grid fix_share;           ///< of the epochs, 0..1
};

/// All cells share an epoch's random draws, so that what differs from cell to cell is the scene's doing and not the
/// noise's. Same bits for any number of threads. `progress` (may be null) advances by cells.
Result<GnssMap> map_gnss(const GnssMapConfig& config, const scene::Scene& scene, Progress* progress);

}  // namespace canyon::study
