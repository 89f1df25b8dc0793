#include "canyon/report/read/json_fields.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/files/json_text.h"
#include "canyon/report/format.h"
#include "canyon/report/read/number_limit.h"

namespace canyon::report {
namespace {

constexpr const char* kPlausible = "a number of at most 1e15 in size";
static_assert(kLargestNumber == 1e15);

bool is_plausible(double value) {
  return std::abs(value) <= kLargestNumber;
}

std::string joined(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : path + "." + std::string(key);
}

/// How many values stand before `wanted` in the text; true if it is there.
bool count_before(const JsonNode& node, const JsonNode& wanted, std::size_t& count) {
  if (&node == &wanted) return true;
  ++count;
  if (!node.is_structured()) return false;
  for (const JsonNode& child : node)
    if (count_before(child, wanted, count)) return true;
  return false;
}

}  // namespace

Result<JsonFile> JsonFile::parse(std::string_view text, const std::string& path) {
  JsonFile out;
  out.path_ = path;
  CANYON_TRY(JsonNode root, parse_ordered_json(text, path, {.same_key_twice = false, .lines = &out.lines_}));
  out.root_ = std::make_shared<const JsonNode>(std::move(root));
  return out;
}

int JsonFile::line_of(const JsonNode& value) const {
  std::size_t before = 0;
  return count_before(*root_, value, before) ? lines_[before] : 0;
}

Error JsonFile::mistake(const JsonNode& at, std::string key, std::string what, std::string expected) const {
  return Error{path_, line_of(at), std::move(key), std::move(what), std::move(expected)};
}

std::string describe(const JsonNode& node) {
  if (node.is_null() || node.is_boolean()) return node.dump();
  if (node.is_number_float()) return "number " + show_number(node.get<double>(), 6);
  if (node.is_number()) return "number " + node.dump();
  if (node.is_string()) return "string \"" + node.get_ref<const std::string&>().substr(0, 40) + "\"";
  return node.is_array() ? "a list of " + std::to_string(node.size()) : "an object";
}

JsonFields::JsonFields(const JsonNode* node, const JsonFile& file, std::string path, std::optional<Error>& error)
    : node_(node && node->is_object() ? node : nullptr), file_(file), path_(std::move(path)), error_(error) {
  if (node && !node->is_null() && !node_) fail(node, {}, describe(*node), "an object");
}

const JsonNode* JsonFields::find(std::string_view key) const {
  if (!node_) return nullptr;
  const auto found = node_->find(key);
  return found == node_->end() ? nullptr : &*found;
}

std::string JsonFields::path_of(std::string_view key) const {
  return key.empty() ? path_ : joined(path_, key);
}

void JsonFields::fail(const JsonNode* at, std::string_view key, std::string what, std::string expected) const {
  if (error_) return;
  error_ = Error{file_.path(), 0, path_of(key), std::move(what), std::move(expected)};
  if (at || node_) error_->line = file_.line_of(at ? *at : *node_);
}

bool JsonFields::has(std::string_view key) const {
  const JsonNode* node = find(key);
  return node && !node->is_null();
}

double JsonFields::number(std::string_view key) const {
  if (!has(key)) return std::nan("");
  const JsonNode* node = find(key);
  if (node->is_number() && is_plausible(node->get<double>())) return without_dust(node->get<double>());
  fail(node, key, describe(*node), node->is_number() ? kPlausible : "a number or null");
  return std::nan("");
}

double JsonFields::share(std::string_view key) const {
  const double v = number(key);
  if (v < 0 || v > 1) fail(find(key), key, describe(*find(key)), "a share between 0 and 1");
  return v;
}

bool JsonFields::flag(std::string_view key) const {
  if (!has(key)) return false;
  const JsonNode* node = find(key);
  if (node->is_boolean()) return node->get<bool>();
  fail(node, key, describe(*node), "true or false");
  return false;
}

std::string JsonFields::text(std::string_view key) const {
  if (!has(key)) return {};
  const JsonNode* node = find(key);
  if (node->is_string()) return node->get<std::string>();
  fail(node, key, describe(*node), "a string or null");
  return {};
}

std::string JsonFields::required_text(std::string_view key) const {
  if (!has(key)) fail(find(key), key, find(key) ? "null" : "missing", "a string");
  return text(key);
}

double JsonFields::required_number(std::string_view key) const {
  if (!has(key)) fail(find(key), key, find(key) ? "null" : "missing", "a number");
  return number(key);
}

std::string JsonFields::digits(std::string_view key) const {
  if (!has(key)) return {};
  const JsonNode* node = find(key);
  if (node->is_number_integer()) return node->dump();
  fail(node, key, describe(*node), "an integer or null");
  return {};
}

std::vector<std::pair<const JsonNode*, std::string>> JsonFields::list(std::string_view key, bool required) const {
  std::vector<std::pair<const JsonNode*, std::string>> out;
  if (!has(key)) {
    if (required) fail(find(key), key, find(key) ? "null" : "missing", "a list");
    return out;
  }
  const JsonNode* node = find(key);
  if (!node->is_array()) {
    fail(node, key, describe(*node), "a list");
    return out;
  }
  for (std::size_t i = 0; i < node->size(); ++i) {
    out.emplace_back(&(*node)[i], path_of(key) + "[" + std::to_string(i) + "]");
  }
  return out;
}

std::vector<double> JsonFields::numbers(std::string_view key, std::size_t size) const {
  if (!has(key)) return {};
  return json_numbers(*find(key), size, file_, path_of(key), error_);
}

JsonFields JsonFields::object(std::string_view key) const {
  return JsonFields(find(key), file_, path_of(key), error_);
}

std::vector<double> json_numbers(const JsonNode& node, std::size_t size, const JsonFile& file, const std::string& path,
                                 std::optional<Error>& error) {
  std::vector<double> out;
  if (node.is_array() && node.size() == size) {
    for (const JsonNode& element : node) {
      if (element.is_number()) {
        const auto value = element.get<double>();
        if (!is_plausible(value)) {
          if (!error) error = file.mistake(element, path, describe(element), kPlausible);
          break;
        }
        out.push_back(without_dust(value));
      } else if (element.is_null()) {
        out.push_back(std::nan(""));
      } else {
        break;
      }
    }
  }
  if (out.size() == size) return out;
  if (!error) error = file.mistake(node, path, describe(node), "a list of " + std::to_string(size) + " numbers");
  return std::vector<double>(size, std::nan(""));
}

}  // namespace canyon::report
