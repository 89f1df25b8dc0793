// A figure that nobody planned, as somebody would add it: one row, in the product at the foot of
// study/results/figures.cpp.
#pragma once

#include "canyon/study/results/figures.h"

namespace canyon::study {

inline constexpr Figure kFixShare{
    .group = "Satellites",
    .key = "fix_share",
    .unit = "%",
    .label = "epochs with a fix",
    .better = Better::kHigher,
    .kind = Figure::Kind::kShare,
    .decimals = 0,
    .get = [](const RunSummary& s) { return s.fixes_due > 0 ? 1.0 - s.fixes_lost / double(s.fixes_due) : kNaN; },
    .meaning = "of those due",
};

}  // namespace canyon::study
