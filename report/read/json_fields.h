#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "canyon/core/result.h"

namespace canyon::report {

using JsonNode = nlohmann::ordered_json;

/// The tree of a JSON file, and the line that each of its values stands on.
class JsonFile {
 public:
  /// The whole text must be one JSON value, no object may have a key twice. `path` is named in errors.
  static Result<JsonFile> parse(std::string_view text, const std::string& path);

  const JsonNode& root() const { return *root_; }
  const std::string& path() const { return path_; }
  /// Of a value of this tree; for messages, it goes through all that stand before.
  int line_of(const JsonNode& value) const;
  Error mistake(const JsonNode& at, std::string key, std::string what, std::string expected) const;

 private:
  std::string path_;
  std::shared_ptr<const JsonNode> root_;
  std::vector<int> lines_;  // in the order of the text
};

/// "number 3.5", "string \"x\"", "null", "a list of 4": for messages.
std::string describe(const JsonNode& node);

/// Reads the members of one object; keeps the first mistake it meets and goes on with defaults, so that a reader is a
/// plain list of fields. Ask error() at the end. Members that are missing or null are undefined: NaN, empty, false.
class JsonFields {
 public:
  /// `path` is the dotted place of the object in the file, for messages. A node that is no object is a mistake; nullptr
  /// is not.
  JsonFields(const JsonNode* node, const JsonFile& file, std::string path, std::optional<Error>& error);

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
  const JsonNode* find(std::string_view key) const;
  bool has(std::string_view key) const;

  void fail(const JsonNode* at, std::string_view key, std::string what, std::string expected) const;
  std::string path_of(std::string_view key) const;
  const JsonFile& file() const { return file_; }
  /// The object itself; nullptr if there is none.
  const JsonNode* node() const { return node_; }
  std::optional<Error>& error() const { return error_; }

 private:
  const JsonNode* node_;
  const JsonFile& file_;
  std::string path_;
  std::optional<Error>& error_;
};

/// `size` numbers out of an array node; NaN for null. A mistake is put into `error`.
std::vector<double> json_numbers(const JsonNode& node, std::size_t size, const JsonFile& file, const std::string& path,
                                 std::optional<Error>& error);

}  // namespace canyon::report
