#pragma once

#include <string>

#include "canyon/report/tradeoff/tradeoff_summary.h"

namespace canyon::report {

/// What the colours of a work-precision diagram mean: classes of runs (draw/theme.h).
enum TradeoffColour : std::size_t { kFront = 0, kInUse = 1, kReference = 2, kDominated = 5 };
inline constexpr std::size_t kTradeoffColours = 6;

/// One ladder: its diagram, error over run time on logarithmic axes, and its table. `id` of the HTML element.
std::string ladder_section(const TradeoffLadder& ladder, const std::string& id);

}  // namespace canyon::report
