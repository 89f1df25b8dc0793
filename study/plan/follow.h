#pragma once

#include <string>

#include "canyon/study/compare.h"

namespace canyon::study {

/// Makes all runs of a comparison leave out what a plan says: that of a file, which must have been made for every run,
/// or, with an empty path, one made here for each run and these outputs. `open_loop`: the runs are on a tape. Called
/// once, before anything is driven.
Status follow_plan(const std::string& path, const std::vector<Output>& outputs, bool open_loop, Comparison& comparison);

}  // namespace canyon::study
