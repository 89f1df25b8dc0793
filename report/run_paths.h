#pragma once

#include <string>
#include <vector>

#include "report/map_drawing.h"
#include "report/results.h"

namespace canyon::report {

/// Where a run really went (a broad, pale ribbon) and where it believed to be (a fine line), as SVG for a plan: while
/// both agree the line stays inside the ribbon. Epochs outside `window`, if given, are left out. `tolerance_m` of
/// simplification.
std::string draw_paths(const MapDrawing& map, const Run& run, std::size_t run_number, const MapWindow* window,
                       double tolerance_m);

/// Fine lines from truth to estimate about once every `every_s` in a window.
std::string draw_error_ties(const MapDrawing& map, const Run& run, std::size_t run_number, const MapWindow& window,
                            double every_s);

/// Positions at equal times for the cursor that links charts and plan; empty without epochs.
std::string draw_track(const MapDrawing& map, const Run& run, std::size_t run_number);

}  // namespace canyon::report
