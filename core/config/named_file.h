#pragma once

#include <string>

#include "canyon/core/config/config.h"

namespace canyon {

/// Where a file lies that `node` names as `path`: a relative one starts in the folder of the file that names it, one
/// that the command line names (a node without a line) in the working folder.
std::string path_as_named(const ConfigNode& node, const std::string& path);

/// What is wrong with a file that `node` names under `key`, read as `path`: that it cannot be read is told where it is
/// named, and so is what no file stands behind; a mistake in it stays at its own line.
Error error_as_named(const ConfigNode& node, const std::string& key, const std::string& path, const Error& error);

}  // namespace canyon
