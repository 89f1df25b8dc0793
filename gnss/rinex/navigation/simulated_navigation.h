#pragma once

#include <string>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/gnss/satellites/navigation_data.h"

namespace canyon::gnss {

/// Records that show a reader of RINEX 3 the satellites that were simulated.
struct SimulatedNavigation {
  NavigationData data;
  std::vector<std::string> warnings;  ///< satellites that were simulated without any record, by name
};

/// Of the records in `broadcast` those of `systems` that count in [start, end]; for satellites that RINEX 3 cannot
/// describe by them (almanacs, B-CNAV, clock epochs with fractions), or that have none (built-in constellations),
/// records fitted to `constellation`. What comes out is compared with `constellation` every five minutes: an Error
/// where they lie more than a metre apart, a warning where a satellite is missing.
Result<SimulatedNavigation> simulated_navigation(const Constellation& constellation, const NavigationData& broadcast,
                                                 const std::string& systems, GpsTime start, GpsTime end);

}  // namespace canyon::gnss
