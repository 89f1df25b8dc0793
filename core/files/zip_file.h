#pragma once

#include <string>
#include <string_view>

#include "canyon/core/result.h"

namespace canyon {

/// The first member of a ZIP archive whose name ends with `ending` (upper or lower case), stored or deflated. No
/// archives of more than 4 GB, no encryption.
Result<std::string> read_zip_member(const std::string& path, std::string_view ending);

}  // namespace canyon
