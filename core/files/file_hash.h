#pragma once

#include <string>

#include "canyon/core/result.h"

namespace canyon {

/// SHA-256 of a file of any size, as sha256_hex() of its bytes, which are not held.
Result<std::string> sha256_of_file(const std::string& path);

}  // namespace canyon
