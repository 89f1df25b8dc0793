#pragma once

#include <string>
#include <system_error>

namespace canyon {

/// What was written survives a loss of power: the bytes of an open file, or all files and folders of a tree (looks at
/// the cancel flag). File systems that cannot say so count as done.
std::error_code sync_file(int descriptor);
std::error_code sync_tree(const std::string& directory);
/// The names in the folder that holds `path`.
void sync_names_beside(const std::string& path);

/// Renames where nothing of the new name exists, else std::errc::file_exists.
std::error_code rename_to_new(const std::string& from, const std::string& to);
/// Both names change places in one step; std::errc::not_supported where the file system cannot.
std::error_code exchange_names(const std::string& a, const std::string& b);

}  // namespace canyon
