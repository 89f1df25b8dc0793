#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "canyon/core/result.h"

namespace canyon {

/// A member of an object with its name, or of a list without, and the line at which it begins.
struct JsonMember {
  std::string name;
  int line = 0;
};

/// What is wanted of a JSON text beside its tree.
struct JsonReading {
  int first_line = 1;                          ///< of the text in its file
  bool same_key_twice = true;                  ///< is no mistake: the last one counts
  std::vector<int>* lines = nullptr;           ///< gets the line of every value, in the order of the text
  std::string_view key = {};                   ///< of the outermost object, whose members `members` gets
  std::vector<JsonMember>* members = nullptr;  ///< in the order of the text
};

/// The text as a tree: one JSON value of at most 100 levels, whose numbers a double can hold. A mistake is told with
/// its line; `path` names the file.
Result<nlohmann::json> parse_json(std::string_view text, const std::string& path, const JsonReading& reading = {});

/// Like parse_json, with the members of objects in the order of the text. Finding one takes as long as an object has
/// members.
Result<nlohmann::ordered_json> parse_ordered_json(std::string_view text, const std::string& path,
                                                  const JsonReading& reading = {});

/// The tree as text: on one line, or indented by so many blanks a level. What is no UTF-8, as the names of files may
/// be, becomes U+FFFD.
std::string json_text(const nlohmann::json& tree, int indent = -1);
std::string json_text(const nlohmann::ordered_json& tree, int indent = -1);

/// A member that is a text; empty if there is none, or something else.
std::string json_string(const nlohmann::json& object, const char* key);

}  // namespace canyon
