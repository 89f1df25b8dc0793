#pragma once

#include <string>
#include <vector>

#include "canyon/core/files/pcd.h"

namespace canyon::testing {

/// LZF: runs of bytes as they are, and copies of what came before.
std::string lzf_packed(const std::string& bytes);

/// A PCD of compressed data, as PCL writes it. `columns`: the bytes of all points' values, field by field.
std::string packed_pcd(const std::vector<PcdField>& fields, std::size_t points, const std::string& columns);

}  // namespace canyon::testing
