#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "canyon/core/result.h"

namespace canyon::scene {

/// JSON out of a file's text; a mistake is told with its line, counted from `first_line`.
Result<nlohmann::json> parse_json(std::string_view text, const std::string& path, int first_line = 1);

/// A member of a list, or of an object with its name, and the line at which it begins.
struct JsonMember {
  std::string name;  ///< as it is written, escapes and all
  int line = 0;
};
/// The members of what the outermost object has under `key`, in the file's order; none if it has no such list or
/// object. `text` is valid JSON.
std::vector<JsonMember> members_of(std::string_view text, std::string_view key);

/// A member that is a text; empty if there is none, or something else.
std::string text_of(const nlohmann::json& object, const char* key);

}  // namespace canyon::scene
