#pragma once

namespace canyon {

/// Version of the product, "0.1.0": that of project() in CMakeLists.txt.
extern const char* const kVersion;

}  // namespace canyon
