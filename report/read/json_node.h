#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "canyon/core/result.h"

namespace canyon::report {

/// A JSON value that remembers the line it stood on, so that a mistake in a results directory can be told by file and
/// line. Numbers are doubles, as JSON's are; integers beyond 2^53 keep their digits in `text`.
struct JsonNode {
  using Array = std::vector<JsonNode>;
  struct Object {
    std::vector<JsonNode> members;  ///< each with its key, in the file's order
  };

  std::variant<std::monostate, bool, double, std::string, Array, Object> value;  ///< monostate: null
  int line = 0;
  std::string text;      ///< an integer as written; else empty
  std::string key = {};  ///< its name, if it is a member of an object

  bool is_null() const { return value.index() == 0; }
  const double* number() const { return std::get_if<double>(&value); }
  const std::string* string() const { return std::get_if<std::string>(&value); }
  const Array* array() const { return std::get_if<Array>(&value); }
  const Object* object() const { return std::get_if<Object>(&value); }
  /// Member of an object; nullptr if this is no object or has no such member.
  const JsonNode* find(std::string_view name) const;
  /// "number 3.5", "string \"x\"", "null", "list of 4": for messages.
  std::string describe() const;
};

/// The whole text must be one JSON value. `file` is named in errors.
Result<JsonNode> parse_json(std::string_view text, const std::string& file);

/// Reads the members of one object; keeps the first mistake it meets and goes on with defaults, so that a reader is a
/// plain list of fields. Ask error() at the end. Members that are missing or null are undefined: NaN, empty, false.
class JsonFields {
 public:
  /// `path` is the dotted place of the object, for messages. A node that is no object is a mistake; nullptr is not.
  JsonFields(const JsonNode* node, std::string file, std::string path, std::optional<Error>& error);

  double number(std::string_view key) const;
  /// A number in [0, 1].
  double share(std::string_view key) const;
  bool flag(std::string_view key) const;
  std::string text(std::string_view key) const;
  /// Like text and number, but missing or null is a mistake.
  std::string required_text(std::string_view key) const;
  double required_number(std::string_view key) const;
  /// An integer of any size as its digits; empty if undefined.
  std::string digits(std::string_view key) const;
  /// A list; its elements with their places ("runs[2]") for further readers. Empty if undefined.
  std::vector<std::pair<const JsonNode*, std::string>> list(std::string_view key, bool required = false) const;
  /// A list of `size` numbers; undefined: empty. null elements are NaN.
  std::vector<double> numbers(std::string_view key, std::size_t size) const;
  JsonFields object(std::string_view key) const;
  const JsonNode* find(std::string_view key) const { return node_ ? node_->find(key) : nullptr; }
  bool has(std::string_view key) const;

  void fail(const JsonNode* at, std::string_view key, std::string what, std::string expected) const;
  std::string path_of(std::string_view key) const;
  const std::string& file() const { return file_; }
  const JsonNode* node() const { return node_; }
  std::optional<Error>& error() const { return error_; }

 private:
  const JsonNode* node_;
  std::string file_;
  std::string path_;
  std::optional<Error>& error_;
};

/// `size` numbers out of an array node; NaN for null. A mistake is put into `error`.
std::vector<double> json_numbers(const JsonNode& node, std::size_t size, const std::string& file,
                                 const std::string& path, std::optional<Error>& error);

}  // namespace canyon::report
