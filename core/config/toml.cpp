#include <sstream>

#include "canyon/core/config/config.h"
#include "canyon/core/files/files.h"

#define TOML_EXCEPTIONS 0
#include <toml++/toml.h>

namespace canyon {
namespace {

ConfigNode convert(const toml::node& node, const std::string& file_name) {
  ConfigNode out;
  out.file_ = file_name;
  out.line_ = static_cast<int>(node.source().begin.line);
  if (const toml::table* table = node.as_table()) {
    ConfigNode::Table children;
    for (const auto& [key, child] : *table) {
      ConfigNode value = convert(child, file_name);
      value.line_ = static_cast<int>(key.source().begin.line);  // a table's own place may be its header's
      children.emplace(std::string(key.str()), std::move(value));
    }
    out.value_ = std::move(children);
  } else if (const toml::array* array = node.as_array()) {
    ConfigNode::Array children;
    for (const toml::node& child : *array) children.push_back(convert(child, file_name));
    out.value_ = std::move(children);
  } else if (const auto* text = node.as_string()) {
    out.value_ = text->get();
  } else if (const auto* integer = node.as_integer()) {
    out.value_ = std::int64_t{integer->get()};
  } else if (const auto* number = node.as_floating_point()) {
    out.value_ = number->get();
  } else if (const auto* flag = node.as_boolean()) {
    out.value_ = flag->get();
  } else {
    // Dates and times, which TOML allows without quotes, are read as if quoted; who wants a time parses the text.
    std::ostringstream date;
    node.visit([&date](const auto& value) {
      if constexpr (toml::is_chronological<decltype(value)>) date << value;
    });
    out.value_ = date.str();
  }
  return out;
}

}  // namespace

Result<ConfigNode> ConfigNode::parse(std::string_view toml, const std::string& file_name) {
  const toml::parse_result parsed = toml::parse(toml, file_name);
  if (!parsed) {
    Error error;
    error.file = file_name;
    error.line = static_cast<int>(parsed.error().source().begin.line);
    error.what = "not valid TOML: " + std::string(parsed.error().description());
    error.expected = "TOML 1.0";
    return error;
  }
  ConfigNode root = convert(parsed.table(), file_name);
  root.line_ = 0;
  return root;
}

Result<ConfigNode> ConfigNode::load(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_file(path));
  return parse(text, path);
}

}  // namespace canyon
