#include <algorithm>
#include <cmath>
#include <optional>

#include "core/config.h"
#include "core/config_text.h"

namespace canyon {
namespace {

/// Sets fields from one table. Collects errors instead of stopping, so that the first of the file can be told.
class Reader final : public FieldVisitor {
 public:
  Reader(const ConfigNode& node, std::string prefix, std::vector<Error>& errors)
      : table_(node.table()), prefix_(std::move(prefix)), errors_(errors) {
    if (!table_) errors_.push_back(node.error(prefix_, "found " + node.describe(), "a table"));
  }

  void number(const char* key, double& value, Range range, const char*) override {
    if (const ConfigNode* node = take(key)) {
      if (const auto v = checked_number(*node, path(key), range)) value = *v;
    }
  }

  void integer(const char* key, std::int64_t& value, Range range, const char*) override {
    const ConfigNode* node = take(key);
    if (!node) return;
    const auto* v = std::get_if<std::int64_t>(&node->value_);
    if (!v) {
      fail(*node, path(key), "found " + node->describe(), range_text(range, true));
    } else if (static_cast<double>(*v) < range.min || static_cast<double>(*v) > range.max) {
      fail(*node, path(key), std::to_string(*v) + " is out of range", range_text(range, true));
    } else {
      value = *v;
    }
  }

  void flag(const char* key, bool& value, const char*) override {
    if (const ConfigNode* node = take(key)) {
      if (const auto v = typed<bool>(*node, path(key), "true or false")) value = *v;
    }
  }

  void text(const char* key, std::string& value, const char*) override {
    if (const ConfigNode* node = take(key)) {
      if (const auto v = typed<std::string>(*node, path(key), "a string")) value = *v;
    }
  }

  void choice(const char* key, std::string& value, const std::vector<std::string>& allowed, const char*) override {
    const ConfigNode* node = take(key);
    if (!node) return;
    const std::string expected = "one of " + quoted_list(allowed);
    const auto v = typed<std::string>(*node, path(key), expected);
    if (!v) return;
    if (std::find(allowed.begin(), allowed.end(), *v) != allowed.end()) {
      value = *v;
      return;
    }
    const std::string nearest = nearest_word(*v, allowed);
    fail(*node, path(key), "unknown name \"" + *v + "\"",
         expected + (nearest.empty() ? "" : "; nearest is \"" + nearest + "\""));
  }

  void numbers(const char* key, std::vector<double>& value, std::size_t size, Range range, const char*) override {
    const ConfigNode* node = take(key);
    if (!node) return;
    const ConfigNode::Array* array = node->array();
    if (!array || (size > 0 && array->size() != size)) {
      fail(*node, path(key), "found " + node->describe(),
           size > 0 ? "a list of " + std::to_string(size) + " numbers" : "a list of numbers");
      return;
    }
    std::vector<double> read;
    for (std::size_t i = 0; i < array->size(); ++i) {
      if (const auto v = checked_number((*array)[i], item_path(key, i), range)) read.push_back(*v);
    }
    if (read.size() == array->size()) value = std::move(read);
  }

  void texts(const char* key, std::vector<std::string>& value, const char*) override {
    const ConfigNode* node = take(key);
    if (!node) return;
    const ConfigNode::Array* array = node->array();
    if (!array) {
      fail(*node, path(key), "found " + node->describe(), "a list of strings");
      return;
    }
    std::vector<std::string> read;
    for (std::size_t i = 0; i < array->size(); ++i) {
      if (const auto v = typed<std::string>((*array)[i], item_path(key, i), "a string")) read.push_back(*v);
    }
    if (read.size() == array->size()) value = std::move(read);
  }

  /// Every key of the table that no field asked for is a mistake.
  void refuse_unknown_keys() {
    if (!table_) return;
    for (const auto& [key, node] : *table_) {
      if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
      const std::string nearest = nearest_word(key, known_);
      std::string expected = "one of the documented keys";
      if (!nearest.empty()) {
        expected += "; nearest is \"" + nearest + "\"";
      } else if (!known_.empty()) {
        expected += ": " + quoted_list(known_);
      }
      fail(node, path(key), "unknown key", expected);
    }
  }

 protected:
  void group_impl(const char* key, const char*, const std::function<void(FieldVisitor&)>& body) override {
    if (const ConfigNode* node = take(key)) read_table(*node, path(key), body);
  }

  void list_impl(const char* key, const char*, std::size_t, const std::function<void(std::size_t)>& resize,
                 const std::function<void(std::size_t, FieldVisitor&)>& item) override {
    const ConfigNode* node = take(key);
    if (!node) return;
    const ConfigNode::Array* array = node->array();
    if (!array) {
      fail(*node, path(key), "found " + node->describe(), "a list of tables");
      return;
    }
    resize(0);  // every item starts from the defaults of its type, not from what stood there before
    resize(array->size());
    for (std::size_t i = 0; i < array->size(); ++i) {
      read_table((*array)[i], item_path(key, i), [&](FieldVisitor& f) { item(i, f); });
    }
  }

 private:
  void read_table(const ConfigNode& node, const std::string& where, const std::function<void(FieldVisitor&)>& body) {
    Reader reader(node, where, errors_);
    body(reader);
    reader.refuse_unknown_keys();
  }

  const ConfigNode* take(const char* key) {
    known_.emplace_back(key);
    if (!table_) return nullptr;
    const auto it = table_->find(key);
    return it == table_->end() ? nullptr : &it->second;
  }

  std::optional<double> checked_number(const ConfigNode& node, const std::string& where, Range range) {
    double v = 0.0;
    if (const auto* number = std::get_if<double>(&node.value_)) {
      v = *number;
    } else if (const auto* whole = std::get_if<std::int64_t>(&node.value_)) {
      v = static_cast<double>(*whole);
    } else {
      fail(node, where, "found " + node.describe(), range_text(range, false));
      return std::nullopt;
    }
    if (!std::isfinite(v)) {
      fail(node, where, number_text(v) + " is not a finite number", range_text(range, false));
      return std::nullopt;
    }
    if (v < range.min || v > range.max) {
      fail(node, where, number_text(v) + " is out of range", range_text(range, false));
      return std::nullopt;
    }
    return v;
  }

  template <class T>
  std::optional<T> typed(const ConfigNode& node, const std::string& where, const std::string& expected) {
    if (const auto* v = std::get_if<T>(&node.value_)) return *v;
    fail(node, where, "found " + node.describe(), expected);
    return std::nullopt;
  }

  void fail(const ConfigNode& node, const std::string& where, std::string what, std::string expected) {
    errors_.push_back(node.error(where, std::move(what), std::move(expected)));
  }

  std::string path(const std::string& key) const { return prefix_.empty() ? key : prefix_ + "." + key; }
  std::string item_path(const std::string& key, std::size_t i) const {
    return path(key) + "[" + std::to_string(i) + "]";
  }

  const ConfigNode::Table* table_;
  std::string prefix_;
  std::vector<Error>& errors_;
  std::vector<std::string> known_;
};

}  // namespace

void FieldVisitor::vector3(const char* key, Eigen::Vector3d& value, Range range, const char* doc) {
  std::vector<double> list{value.x(), value.y(), value.z()};
  numbers(key, list, 3, range, doc);
  value << list[0], list[1], list[2];
}

void FieldVisitor::vector2(const char* key, Eigen::Vector2d& value, Range range, const char* doc) {
  std::vector<double> list{value.x(), value.y()};
  numbers(key, list, 2, range, doc);
  value << list[0], list[1];
}

Status read_fields(const ConfigNode* node, const std::string& prefix, const VisitFunction& visit_fields) {
  if (!node) return Ok{};
  std::vector<Error> errors;
  Reader reader(*node, prefix, errors);
  if (errors.empty()) {
    visit_fields(reader);
    reader.refuse_unknown_keys();
  }
  if (errors.empty()) return Ok{};
  // Of several mistakes in the file of the first one, the topmost is told.
  const auto topmost = std::min_element(errors.begin(), errors.end(), [&](const Error& a, const Error& b) {
    const bool a_elsewhere = a.file != errors.front().file;
    const bool b_elsewhere = b.file != errors.front().file;
    return std::pair(a_elsewhere, a.line) < std::pair(b_elsewhere, b.line);
  });
  return *topmost;
}

}  // namespace canyon
