#pragma once

#include <string>

#include "canyon/study/dead_reckoning/dead_reckoning.h"

/// What `imu dead-reckon` says: as text, as a drawing.
namespace canyon::apps {

void print_dead_reckoning(const study::DeadReckoning& result);
std::string dead_reckoning_svg(const study::DeadReckoning& result, const study::PlainIntegrals& plain);

}  // namespace canyon::apps
