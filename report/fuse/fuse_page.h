#pragma once

#include <string>

#include "canyon/core/result.h"

namespace canyon::report {

/// One self-contained HTML page of what `canyon fuse --out` has left in a directory: the verdict on the filter, errors
/// over time with what the filter claimed, outages, innovations. No address outside itself, readable without scripts.
Result<std::string> fuse_page(const std::string& directory);

}  // namespace canyon::report
