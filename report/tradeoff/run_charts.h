#pragma once

#include <string>

#include "canyon/report/tradeoff/tradeoff_summary.h"

namespace canyon::report {

/// Missions as a whole: position, map and registration error over CPU time on logarithmic axes, a panel each with the
/// front as a staircase; empty where nothing has an error.
std::string run_error_charts(const TradeoffSummary& t);

/// The share of successes, with its interval, over the CPU time of a mission to its end; empty where none was driven.
std::string run_outcome_chart(const TradeoffSummary& t);

}  // namespace canyon::report
