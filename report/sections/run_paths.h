#pragma once

#include <string>
#include <vector>

#include "canyon/report/maps/map_drawing.h"
#include "canyon/report/read/results.h"

namespace canyon::report {

/// Where a run really went, as a pale ribbon of that width for a plan; an estimate that is good stays inside it. Epochs
/// far outside `window`, if given, are left out. `tolerance_m` of simplification. Empty without epochs.
std::string draw_ribbon(const MapDrawing& map, const Run& run, std::size_t run_number, const MapWindow* window,
                        double tolerance_m, double width_px);

/// Where a run believed to be, as a fine line.
std::string draw_estimate(const MapDrawing& map, const Run& run, std::size_t run_number, const MapWindow* window,
                          double tolerance_m);

/// Fine lines from truth to estimate about once every `every_s` in a window.
std::string draw_error_ties(const MapDrawing& map, const Run& run, std::size_t run_number, const MapWindow& window,
                            double every_s);

/// Positions at equal times for the cursor that links charts and plan; empty without epochs.
std::string draw_track(const MapDrawing& map, const Run& run, std::size_t run_number);

}  // namespace canyon::report
