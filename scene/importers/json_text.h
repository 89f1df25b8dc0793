#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "core/result.h"

namespace canyon::scene {

/// JSON out of a file's text; a mistake is told with its line, counted from `first_line`.
Result<nlohmann::json> parse_json(std::string_view text, const std::string& path, int first_line = 1);

/// A member that is a text; empty if there is none, or something else.
std::string text_of(const nlohmann::json& object, const char* key);

}  // namespace canyon::scene
