#pragma once

#include <cstdint>
#include <string>

#include "canyon/core/result.h"
#include "canyon/study/compare.h"

namespace canyon::study {

/// The runs of a comparison in closed loop, the mixed ones left out, on one true motion.
Result<Comparison> open_loop_beside(const Comparison& closed, const TapeChoice& choice);

/// Drives them, each with so many seeds from the mission's own on. Figures alone; `scratch` is a folder for what is
/// written on the way and not kept.
Result<OpenLoopRuns> drive_open_loop(const Comparison& open, std::int64_t seeds, const std::string& scratch,
                                     bool show_progress);

}  // namespace canyon::study
