#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/model_table.h"
#include "canyon/core/result.h"

namespace canyon {

/// One value of a configuration tree with the place it was written at; what a TOML file becomes after reading.
class ConfigNode {
 public:
  using Table = std::map<std::string, ConfigNode>;
  using Array = std::vector<ConfigNode>;

  ConfigNode() = default;

  static Result<ConfigNode> parse(std::string_view toml, const std::string& file_name);
  static Result<ConfigNode> load(const std::string& path);

  const Table* table() const { return std::get_if<Table>(&value_); }
  const Array* array() const { return std::get_if<Array>(&value_); }
  const ConfigNode* find(std::string_view dotted_key) const;

  /// Lays `over` on top: tables merge key by key, anything else is replaced, and keeps the place it was written at.
  void overlay(const ConfigNode& over);
  /// Removes a key of this table, if there.
  void erase(const std::string& key);
  /// Sets a value at a dotted key, as an option of the command line does; `origin` is named in errors ("--seed").
  void set(std::string_view dotted_key, ConfigNode value, const std::string& origin);

  static ConfigNode of(double v);
  static ConfigNode of(std::int64_t v);
  static ConfigNode of(bool v);
  static ConfigNode of(std::string v);

  /// "float 3.5", "string "x"": for error messages.
  std::string describe() const;
  Error error(const std::string& key, std::string what, std::string expected) const;

  std::variant<std::monostate, bool, std::int64_t, double, std::string, Array, Table> value_;
  std::string file_;
  int line_ = 0;
};

/// The closed interval a number must lie in; NaN and infinities are always refused.
struct Range {
  double min;
  double max;
  double unset = std::numeric_limits<double>::quiet_NaN();  ///< allowed beside it, where not NaN: stands for no number
};
inline constexpr Range kPositive{1e-300, 1e300};
inline constexpr Range kNotNegative{0.0, 1e300};
inline constexpr Range kAnyNumber{-1e300, 1e300};

/// Visits the fields of a configuration struct. One function per struct,
///
///     void visit(FieldVisitor& f, GnssConfig& c) {
///       f.number("rate_hz", c.rate_hz, {0.1, 20}, "fixes per second");
///       ...
///     }
///
/// serves the reader, the manifest, and the documentation. Units are in the key name; human units are allowed here and
/// converted once, where the model is built. A number, or list of numbers, whose default is NaN has no default: the
/// table must hold it.
class FieldVisitor {
 public:
  virtual ~FieldVisitor() = default;
  virtual void number(const char* key, double& value, Range range, const char* doc) = 0;
  virtual void integer(const char* key, std::int64_t& value, Range range, const char* doc) = 0;
  virtual void flag(const char* key, bool& value, const char* doc) = 0;
  virtual void text(const char* key, std::string& value, const char* doc) = 0;
  /// A file's path, or, where `suffix` is not empty and the value does not end with it, a name. A relative path starts
  /// at the folder of the file that it is written in; on the command line, at the current directory.
  virtual void file(const char* key, std::string& value, std::string_view suffix, const char* doc) = 0;
  virtual void files(const char* key, std::vector<std::string>& value, const char* doc) = 0;
  /// A name out of a model table or other fixed list.
  virtual void choice(const char* key, std::string& value, const std::vector<std::string>& allowed,
                      const char* doc) = 0;
  /// A list of names out of a model table, each at most once; one name may stand for a list of it.
  virtual void choices(const char* key, std::vector<std::string>& value, const std::vector<std::string>& allowed,
                       const char* doc) = 0;
  /// A list of numbers; `size` > 0 demands exactly that many.
  virtual void numbers(const char* key, std::vector<double>& value, std::size_t size, Range range, const char* doc) = 0;
  virtual void texts(const char* key, std::vector<std::string>& value, const char* doc) = 0;
  /// A key of earlier versions: an error that names `instead`, what took its place. Neither read nor documented.
  virtual void old_key(const char* /*key*/, const char* /*instead*/) {}
  /// A value of an enumeration, by its name in the table.
  template <class Value>
  void choice(const char* key, Value& value, std::span<const ModelRow<Value>> rows, const char* doc) {
    std::string name = row_of(rows, value).name;
    choice(key, name, model_names(rows), doc);
    value = model_row(rows, name).make;
  }
  /// A number in `range` that may be not set, which is written as `unset`, a value outside of it.
  void optional_number(const char* key, std::optional<double>& value, double unset, Range range, const char* doc);
  void vector3(const char* key, Eigen::Vector3d& value, Range range, const char* doc);
  void vector2(const char* key, Eigen::Vector2d& value, Range range, const char* doc);

  /// A sub-table.
  template <class T>
  void group(const char* key, T& value, const char* doc) {
    group_impl(key, doc, [&value](FieldVisitor& f) { visit(f, value); });
  }
  /// An array of tables.
  template <class T>
  void list(const char* key, std::vector<T>& value, const char* doc) {
    list_impl(
        key, doc, value.size(), [&value](std::size_t n) { value.resize(n); },
        [&value](std::size_t i, FieldVisitor& f) { visit(f, value[i]); });
  }

 protected:
  virtual void group_impl(const char* key, const char* doc, const std::function<void(FieldVisitor&)>& body) = 0;
  virtual void list_impl(const char* key, const char* doc, std::size_t size,
                         const std::function<void(std::size_t)>& resize,
                         const std::function<void(std::size_t, FieldVisitor&)>& item) = 0;
};

using VisitFunction = std::function<void(FieldVisitor&)>;

/// Reads the table at `node` (may be null: defaults stay). An unknown key is an error that names the nearest known key.
/// `prefix` is the dotted path of the table, for messages.
Status read_fields(const ConfigNode* node, const std::string& prefix, const VisitFunction& visit_fields);

template <class T>
Status read_config(const ConfigNode* node, const std::string& prefix, T& config) {
  return read_fields(node, prefix, [&config](FieldVisitor& f) { visit(f, config); });
}

/// The fields as a JSON object, for manifest.json; also what makes two configurations comparable.
std::string fields_as_json(const VisitFunction& visit_fields);

/// What a newcomer needs to know of one field, in words.
struct FieldDoc {
  std::string key;            ///< dotted; the keys of a list's items as "waypoint[].name"
  std::string unit;           ///< out of the key's name; empty where there is none
  std::string default_value;  ///< as TOML; "required" where there is none
  std::string range;          ///< what may be given
  std::string meaning;
};
std::vector<FieldDoc> documented_fields(const std::string& prefix, const VisitFunction& visit_fields);

/// The fields that name files, with what they name: those that are empty or a built-in's name left out.
struct NamedFile {
  std::string key;
  std::string path;
};
std::vector<NamedFile> named_files(const VisitFunction& visit_fields);

/// The word of `known` nearest to `word`: by edit distance, else one that begins like it or holds it, or the other way
/// round; empty when none is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

}  // namespace canyon
