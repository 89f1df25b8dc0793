#pragma once

#include <string>

#include "canyon/study/fuse/smooth.h"

/// What `fuse` says: as text, as a drawing.
namespace canyon::apps {

void print_fused(const study::FuseInputs& inputs, const study::Fused& run, const study::FuseSmoothed* smoothed);
/// Errors with three sigma; there must be errors.
std::string fused_svg(const study::Fused& run);

}  // namespace canyon::apps
