#pragma once

#include <string>

namespace canyon {

/// Version of the product, "0.1.0".
inline constexpr const char* kVersion = "0.1.0";

/// The widest vector instructions of this CPU that change the ray tracer's choice of code: "avx512", "avx2", "avx",
/// "sse4.2" or "baseline". Results are bit-identical within one of these.
std::string instruction_set();

}  // namespace canyon
