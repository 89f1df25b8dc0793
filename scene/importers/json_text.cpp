#include "scene/importers/json_text.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace canyon::scene {

Result<nlohmann::json> parse_json(std::string_view text, const std::string& path, int first_line) {
  try {
    return nlohmann::json::parse(text.begin(), text.end());
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t at = std::min(text.size(), error.byte);
    const auto line =
        first_line + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    return Error{path, line, "", "not valid JSON", "JSON text"};
  } catch (const nlohmann::json::exception&) {
    return Error{path, 0, "", "not valid JSON", "JSON text"};
  }
}

std::string text_of(const nlohmann::json& object, const char* key) {
  const auto member = object.is_object() ? object.find(key) : object.end();
  return member != object.end() && member->is_string() ? member->get<std::string>() : std::string();
}

}  // namespace canyon::scene
