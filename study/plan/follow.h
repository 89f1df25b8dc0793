#pragma once

#include <optional>
#include <string>

#include "canyon/study/compare.h"

namespace canyon::study {

/// Makes all runs of a comparison leave out what a plan says: that of a file, which must have been made for every run,
/// or, with an empty path, one made here for each run. `outputs`: what somebody will read; none: all there is, of a
/// file what it was made for. An Error where somebody will read what the file's plan may have moved or left out. Called
/// once, with the tape chosen, if there is one, and before anything is driven.
Status follow_plan(const std::string& path, const std::optional<std::vector<Output>>& outputs, Comparison& comparison);

}  // namespace canyon::study
