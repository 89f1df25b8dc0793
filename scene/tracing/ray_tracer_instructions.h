#pragma once

#include <string>

#include "canyon/core/result.h"

namespace canyon::scene {

/// The vector instructions that the ray tracer really uses: "avx512", "avx2", "avx", "sse4.2" or "sse2". It has code
/// for each and takes the widest that the CPU knows, or that the environment variable CANYON_RAY_TRACER_MAX_ISA names.
/// Which of two surfaces a ray meets at their common edge depends on it (docs/results.md).
std::string ray_tracer_instruction_set();

/// That the variable, if there is one, names one of them.
Status check_ray_tracer_limit();

}  // namespace canyon::scene
