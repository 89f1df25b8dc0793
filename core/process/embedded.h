#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace canyon {

/// Bytes of a data file compiled into the binary (beam tables, constellation, materials, built-in missions).
/// The key is the file's path in the source tree, for example "scene/materials.toml"; nullopt if there is none.
/// Which files are embedded is said in core/CMakeLists.txt.
std::optional<std::string_view> embedded_file(std::string_view key);

/// Keys of all embedded files that start with `prefix`, sorted.
std::vector<std::string_view> embedded_files(std::string_view prefix);

}  // namespace canyon
