#include <algorithm>
#include <cmath>
#include <optional>

#include "canyon/core/config/config.h"
#include "canyon/core/config/named_file.h"
#include "canyon/core/config/text.h"

namespace canyon {
namespace {

constexpr std::size_t kListedKeys = 8;  // more of them tell nobody anything

/// Mistakes found so far. What is missing is told last: it may be missing because it is misspelt.
struct Mistakes {
  std::vector<Error> wrong, missing;
};

/// Sets fields from one table. Collects errors instead of stopping, so that the first of the file can be told.
class Reader final : public FieldVisitor {
 public:
  Reader(const ConfigNode& node, std::string prefix, Mistakes& mistakes)
      : node_(node), table_(node.table()), prefix_(std::move(prefix)), mistakes_(mistakes) {
    if (!table_) mistakes_.wrong.push_back(node.error(prefix_, "found " + node.describe(), "a table"));
  }

  void number(const char* key, double& value, Range range, const char*) override {
    if (const ConfigNode* node = take(key)) {
      if (const auto v = checked_number(*node, path(key), range)) value = *v;
    } else if (std::isnan(value)) {
      missing(key, range_text(range, false));
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
    const auto v = typed<std::string>(*node, path(key), "one of " + quoted_list(allowed));
    if (!v) return;
    if (std::find(allowed.begin(), allowed.end(), *v) != allowed.end()) {
      value = *v;
      return;
    }
    Error error = unknown_name(path(key), *v, allowed);
    fail(*node, error.key, std::move(error.what), std::move(error.expected));
  }

  void choices(const char* key, std::vector<std::string>& value, const std::vector<std::string>& allowed,
               const char*) override {
    const ConfigNode* node = take(key);
    if (!node) return;
    const std::string expected = "a list out of " + quoted_list(allowed);
    const ConfigNode::Array one{*node};
    const bool is_list = node->array() != nullptr;
    std::vector<std::string> read;
    for (const ConfigNode& item : is_list ? *node->array() : one) {
      const auto name = typed<std::string>(item, path(key), expected);
      if (!name) return;
      if (std::find(allowed.begin(), allowed.end(), *name) == allowed.end()) {
        Error error = unknown_name(path(key), *name, allowed);
        return fail(item, error.key, std::move(error.what), std::move(error.expected));
      }
      if (std::find(read.begin(), read.end(), *name) != read.end())
        return fail(item, path(key), "\"" + *name + "\" stands there twice", expected);
      read.push_back(*name);
    }
    value = std::move(read);
  }

  void numbers(const char* key, std::vector<double>& value, std::size_t size, Range range, const char*) override {
    const ConfigNode* node = take(key);
    const std::string expected = size > 0 ? "a list of " + std::to_string(size) + " numbers" : "a list of numbers";
    if (!node) {
      if (std::any_of(value.begin(), value.end(), [](double v) { return std::isnan(v); })) missing(key, expected);
      return;
    }
    const ConfigNode::Array* array = node->array();
    if (!array || (size > 0 && array->size() != size)) {
      fail(*node, path(key), "found " + node->describe(), expected);
      return;
    }
    std::vector<double> read;
    for (std::size_t i = 0; i < array->size(); ++i) {
      if (const auto v = checked_number((*array)[i], item_path(key, i), range)) read.push_back(*v);
    }
    if (read.size() == array->size()) value = std::move(read);
  }

  void file(const char* key, std::string& value, std::string_view suffix, const char*) override {
    const ConfigNode* node = take(key);
    if (!node) return;
    if (const auto v = typed<std::string>(*node, path(key), "a string"))
      value = v->ends_with(suffix) ? path_as_named(*node, *v) : *v;
  }

  void texts(const char* key, std::vector<std::string>& value, const char*) override {
    read_texts(key, value, [](const ConfigNode&, const std::string& text) { return text; });
  }

  void files(const char* key, std::vector<std::string>& value, const char*) override {
    read_texts(key, value, path_as_named);
  }

  void old_key(const char* key, const char* instead) override {
    if (!table_) return;
    const auto it = table_->find(key);
    if (it == table_->end()) return;
    old_.emplace_back(key);
    fail(it->second, path(key), "is a key of an earlier version", instead);
  }

  /// Every key of the table that no field asked for is a mistake.
  void refuse_unknown_keys() {
    if (!table_) return;
    for (const auto& [key, node] : *table_) {
      if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
      if (std::find(old_.begin(), old_.end(), key) != old_.end()) continue;
      const std::string nearest = nearest_word(key, known_);
      std::string expected = "one of the documented keys";
      if (!nearest.empty()) {
        expected += "; nearest is \"" + nearest + "\"";
      } else if (known_.size() <= kListedKeys) {
        expected += ": " + quoted_list(known_);
      } else {
        expected = "one of the " + std::to_string(known_.size()) + " documented keys";
      }
      fail(node, path(key), "unknown key", expected);
    }
  }

 protected:
  void group_impl(const char* key, const char*, const std::function<void(FieldVisitor&)>& body) override {
    if (const ConfigNode* node = take(key)) {
      read_table(*node, path(key), body);
    } else if (table_) {
      // As if an empty table stood there: its fields may be required.
      ConfigNode empty;
      empty.value_ = ConfigNode::Table{};
      empty.file_ = node_.file_;
      empty.line_ = node_.line_;
      read_table(empty, path(key), body);
    }
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
    Reader reader(node, where, mistakes_);
    body(reader);
    reader.refuse_unknown_keys();
  }

  const ConfigNode* take(const char* key) {
    known_.emplace_back(key);
    if (!table_) return nullptr;
    const auto it = table_->find(key);
    return it == table_->end() ? nullptr : &it->second;
  }

  template <class Convert>
  void read_texts(const char* key, std::vector<std::string>& value, Convert convert) {
    const ConfigNode* node = take(key);
    if (!node) return;
    const ConfigNode::Array* array = node->array();
    if (!array) {
      fail(*node, path(key), "found " + node->describe(), "a list of strings");
      return;
    }
    std::vector<std::string> read;
    for (std::size_t i = 0; i < array->size(); ++i) {
      const ConfigNode& item = (*array)[i];
      if (const auto v = typed<std::string>(item, item_path(key, i), "a string")) read.push_back(convert(item, *v));
    }
    if (read.size() == array->size()) value = std::move(read);
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
    if ((v < range.min || v > range.max) && v != range.unset) {
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
    mistakes_.wrong.push_back(node.error(where, std::move(what), std::move(expected)));
  }

  void missing(const char* key, std::string expected) {
    if (table_) mistakes_.missing.push_back(node_.error(path(key), "is missing", std::move(expected)));
  }

  std::string path(const std::string& key) const { return prefix_.empty() ? key : prefix_ + "." + key; }
  /// Items are counted from 1, as people do.
  std::string item_path(const std::string& key, std::size_t i) const {
    return path(key) + "[" + std::to_string(i + 1) + "]";
  }

  const ConfigNode& node_;
  const ConfigNode::Table* table_;
  std::string prefix_;
  Mistakes& mistakes_;
  std::vector<std::string> known_, old_;
};

/// All that is missing, in one message: the first by its own, the others by name.
Error all_missing(Error first, const std::vector<Error>& errors) {
  std::string others;
  for (const Error& error : errors)
    if (error.key != first.key) others += (others.empty() ? "" : ", ") + error.key;
  if (!others.empty()) first.what += ", and so are " + others;
  return first;
}

}  // namespace

void FieldVisitor::optional_number(const char* key, std::optional<double>& value, double unset, Range range,
                                   const char* doc) {
  double number_or_unset = value.value_or(unset);
  number(key, number_or_unset, {range.min, range.max, unset}, doc);
  if (number_or_unset == unset)
    value.reset();
  else
    value = number_or_unset;
}

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
  Mistakes mistakes;
  Reader reader(*node, prefix, mistakes);
  if (mistakes.wrong.empty()) {
    visit_fields(reader);
    reader.refuse_unknown_keys();
  }
  const std::vector<Error>& errors = mistakes.wrong.empty() ? mistakes.missing : mistakes.wrong;
  if (errors.empty()) return Ok{};
  // Of several mistakes in the file of the first one, the topmost is told.
  const auto topmost = std::min_element(errors.begin(), errors.end(), [&](const Error& a, const Error& b) {
    const bool a_elsewhere = a.file != errors.front().file;
    const bool b_elsewhere = b.file != errors.front().file;
    return std::pair(a_elsewhere, a.line) < std::pair(b_elsewhere, b.line);
  });
  return mistakes.wrong.empty() ? all_missing(*topmost, errors) : *topmost;
}

}  // namespace canyon
