#include "canyon/scene/importers/parsing/json_text.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include <nlohmann/json.hpp>

#include "canyon/core/process/progress.h"

namespace canyon::scene {
namespace {

/// The characters of a text; looks now and then whether the user asked to stop.
struct Reader {
  using iterator_category = std::forward_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;
  const char* at = nullptr;

  reference operator*() const { return *at; }
  Reader& operator++() {
    ++at;
    if ((reinterpret_cast<std::uintptr_t>(at) & 0xfffffu) == 0) throw_if_cancelled();
    return *this;
  }
  Reader operator++(int) {
    const Reader before = *this;
    ++*this;
    return before;
  }
  bool operator==(const Reader&) const = default;
};

}  // namespace

Result<nlohmann::json> parse_json(std::string_view text, const std::string& path, int first_line) {
  try {
    return nlohmann::json::parse(Reader{text.data()}, Reader{text.data() + text.size()});
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t at = std::min(text.size(), error.byte);
    const auto line =
        first_line + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    return Error{path, line, "", "not valid JSON", "JSON text"};
  } catch (const nlohmann::json::exception&) {
    return Error{path, 0, "", "not valid JSON", "JSON text"};
  }
}

std::vector<JsonMember> members_of(std::string_view text, std::string_view key) {
  std::vector<JsonMember> out;
  int depth = 0, line = 1;
  bool inside = false, begins = false;  // of what the key names; one of its members
  std::string_view name;                // the last string of the outermost object
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++line;
    if (c == ' ' || c == '\t' || c == '\r' || c == '\n') continue;
    std::string_view word;
    if (c == '"') {
      std::size_t end = i + 1;
      while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
      word = text.substr(i + 1, std::min(end, text.size()) - i - 1);
      i = end;
      if (depth == 1) name = word;
    }
    if (begins && c != ']' && c != '}') out.push_back({std::string(word), line});
    begins = false;
    if (c == '{' || c == '[') {
      ++depth;
      if (depth == 2 && name == key) inside = begins = true;
    } else if (c == '}' || c == ']') {
      if (inside && depth == 2) return out;
      --depth;
    } else if (c == ',' && inside && depth == 2) {
      begins = true;
    }
  }
  return out;
}

std::string text_of(const nlohmann::json& object, const char* key) {
  const auto member = object.is_object() ? object.find(key) : object.end();
  return member != object.end() && member->is_string() ? member->get<std::string>() : std::string();
}

}  // namespace canyon::scene
