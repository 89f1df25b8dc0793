#include "canyon/core/check.h"
#include "canyon/core/config/config.h"
#include "canyon/core/config/text.h"

namespace canyon {
namespace {

void mark_origin(ConfigNode& node, const std::string& origin) {
  node.file_ = origin;
  node.line_ = 0;
  if (auto* table = std::get_if<ConfigNode::Table>(&node.value_)) {
    for (auto& [key, child] : *table) mark_origin(child, origin);
  } else if (auto* array = std::get_if<ConfigNode::Array>(&node.value_)) {
    for (ConfigNode& child : *array) mark_origin(child, origin);
  }
}

template <class T>
ConfigNode node_of(T value) {
  ConfigNode node;
  node.value_ = std::move(value);
  return node;
}

}  // namespace

const ConfigNode* ConfigNode::find(std::string_view dotted_key) const {
  const ConfigNode* node = this;
  while (true) {
    const std::size_t dot = dotted_key.find('.');
    const Table* inside = node->table();
    if (!inside) return nullptr;
    const auto it = inside->find(std::string(dotted_key.substr(0, dot)));
    if (it == inside->end()) return nullptr;
    node = &it->second;
    if (dot == std::string_view::npos) return node;
    dotted_key.remove_prefix(dot + 1);
  }
}

void ConfigNode::overlay(const ConfigNode& over) {
  auto* mine = std::get_if<Table>(&value_);
  const Table* theirs = over.table();
  if (!mine || !theirs) {
    *this = ConfigNode(over);
    return;
  }
  for (const auto& [key, child] : *theirs) {
    const auto [it, inserted] = mine->try_emplace(key, child);
    if (!inserted) it->second.overlay(child);
  }
}

void ConfigNode::erase(const std::string& key) {
  if (auto* mine = std::get_if<Table>(&value_)) mine->erase(key);
}

void ConfigNode::set(std::string_view dotted_key, ConfigNode value, const std::string& origin) {
  CANYON_CHECK(!dotted_key.empty(), "origin = ", origin);
  const std::size_t dot = dotted_key.find('.');
  if (!table()) {  // empty so far, or a plain value in the way: the option wins
    value_ = Table{};
    file_ = origin;
    line_ = 0;
  }
  ConfigNode& child = std::get<Table>(value_)[std::string(dotted_key.substr(0, dot))];
  if (dot != std::string_view::npos) {
    child.set(dotted_key.substr(dot + 1), std::move(value), origin);
    return;
  }
  child = std::move(value);
  mark_origin(child, origin);
}

ConfigNode ConfigNode::of(double v) {
  return node_of(v);
}
ConfigNode ConfigNode::of(std::int64_t v) {
  return node_of(v);
}
ConfigNode ConfigNode::of(bool v) {
  return node_of(v);
}
ConfigNode ConfigNode::of(std::string v) {
  return node_of(std::move(v));
}

std::string ConfigNode::describe() const {
  struct Describe {
    std::string operator()(std::monostate) const { return "nothing"; }
    std::string operator()(bool v) const { return v ? "boolean true" : "boolean false"; }
    std::string operator()(std::int64_t v) const { return "integer " + std::to_string(v); }
    std::string operator()(double v) const { return "float " + number_text(v); }
    std::string operator()(const std::string& v) const { return "string \"" + v + "\""; }
    std::string operator()(const Array& v) const { return "array of " + std::to_string(v.size()); }
    std::string operator()(const Table&) const { return "a table"; }
  };
  return std::visit(Describe{}, value_);
}

Error ConfigNode::error(const std::string& key, std::string what, std::string expected) const {
  Error e;
  e.file = file_;
  e.line = line_;
  e.key = key;
  e.what = std::move(what);
  e.expected = std::move(expected);
  return e;
}

}  // namespace canyon
