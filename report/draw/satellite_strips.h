#pragma once

#include <string>

#include "canyon/report/draw/chart.h"
#include "canyon/report/read/results.h"

namespace canyon::report {

/// A row per satellite over time: its multipath error as classes of colour, a line beneath while its direct path is
/// blocked, blank while the receiver does not track it. `x` is the time axis of the charts around. The run must have
/// satellites.
std::string draw_satellite_strips(const Results& results, std::size_t run_number, const Axis& x);

/// The classes of multipath error as a legend.
std::string multipath_legend();

}  // namespace canyon::report
