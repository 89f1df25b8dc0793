#include "canyon/study/stress/sweep/finite_results.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/files/pcd.h"
#include "canyon/core/files/tape.h"
#include "canyon/study/stress/sweep/absent_values.h"

namespace canyon::study {
namespace {

namespace fs = std::filesystem;
using Tree = nlohmann::json;

std::vector<std::string_view> pieces(std::string_view text, char border) {
  std::vector<std::string_view> out;
  std::size_t from = 0;
  for (std::size_t at = text.find(border); at != std::string_view::npos; at = text.find(border, from)) {
    out.push_back(text.substr(from, at - from));
    from = at + 1;
  }
  out.push_back(text.substr(from));
  return out;
}

std::optional<double> number(std::string_view text) {
  double value = 0.0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || end.ec != std::errc() || end.ptr != text.data() + text.size()) return {};
  return value;
}

/// The same word, or the same number: "0" and "0.0" are.
bool same(std::string_view a, std::string_view b) {
  const auto first = number(a), second = number(b);
  return first && second ? *first == *second : a == b;
}

/// Whether the list lets `value` be absent; `read` gives the text of a column or key beside it, "" where it is absent.
template <class Read>
bool may_miss(std::string_view kind, std::string_view value, Read&& read) {
  return std::ranges::any_of(may_be_absent(), [&](const MayBeAbsent& row) {
    const auto values = pieces(row.values, ',');
    if (row.file != kind || std::ranges::find(values, value) == values.end()) return false;
    if (*row.when == '\0') return true;
    const std::string is = *row.is == '=' ? read(row.is + 1) : std::string(row.is), found = read(row.when);
    return std::ranges::any_of(pieces(is, ','), [&](std::string_view one) { return same(found, one); });
  });
}

/// "nan", "-inf" and their kin; what is a word or a finite number is not.
bool is_no_number(std::string_view field) {
  double value = 0.0;
  const auto end = std::from_chars(field.data(), field.data() + field.size(), value);
  if (end.ptr != field.data() + field.size() || field.empty()) return false;
  return end.ec == std::errc::result_out_of_range || (end.ec == std::errc() && !std::isfinite(value));
}

std::string wrong_in_row(const std::vector<std::string_view>& columns, const std::vector<std::string_view>& fields,
                         std::string_view kind) {
  if (fields.size() != columns.size())
    return std::to_string(fields.size()) + " fields for " + std::to_string(columns.size()) + " columns";
  const auto read = [&](std::string_view name) {
    const auto at = std::ranges::find(columns, name);
    return at == columns.end() ? "no such column" : std::string(fields[static_cast<std::size_t>(at - columns.begin())]);
  };
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].empty() && !may_miss(kind, columns[i], read)) return std::string(columns[i]) + " is empty";
    if (is_no_number(fields[i])) return std::string(columns[i]) + " is " + std::string(fields[i]);
  }
  return "";
}

std::string text_of(const Tree& object, std::string_view key) {
  const auto found = object.find(std::string(key));
  if (found == object.end()) return "no such key";
  return found->is_null() ? "" : found->is_string() ? found->get<std::string>() : found->dump();
}

std::string wrong_in_tree(const Tree& tree, std::string_view kind, const std::string& path) {
  if (tree.is_null()) return path + " is null";
  if (tree.is_array())
    for (std::size_t i = 0; i < tree.size(); ++i)
      if (auto wrong = wrong_in_tree(tree[i], kind, path + "[" + std::to_string(i) + "]"); !wrong.empty()) return wrong;
  if (!tree.is_object()) return "";
  const auto read = [&tree](std::string_view key) { return text_of(tree, key); };
  for (const auto& [key, value] : tree.items()) {
    if (value.is_null() && may_miss(kind, key, read)) continue;
    if (auto wrong = wrong_in_tree(value, kind, path.empty() ? key : path + "." + key); !wrong.empty()) return wrong;
  }
  return "";
}

/// Whether a page holds nan or inf as a word of its own, as an attribute or a label would.
bool page_holds_no_number(std::string_view text) {
  for (const std::string_view word : {"nan", "inf", "NaN", "Infinity"})
    for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
      const auto apart = [&text](std::size_t i) {
        return i >= text.size() || (std::isalnum(static_cast<unsigned char>(text[i])) == 0 && text[i] != '_');
      };
      if ((at == 0 || apart(at - 1)) && apart(at + word.size())) return true;
    }
  return false;
}

std::string wrong_in_cloud(const std::string& path) {
  auto cloud = PcdReader::open(path);
  if (!cloud) return cloud.error().str();
  while (true) {
    const auto bytes = cloud->next();
    if (!bytes) return bytes.error().str();
    if (bytes->empty()) return "";
    for (std::size_t at = 0; at + sizeof(float) <= bytes->size(); at += sizeof(float)) {
      float value = 0.0F;  // all fields of a scored map are
      std::memcpy(&value, bytes->data() + at, sizeof value);
      if (!std::isfinite(value)) return "a point that is not finite";
    }
  }
}

std::string wrong_in_tape(const std::string& path) {
  const auto tape = read_tape(path);
  return tape ? "" : tape.error().str();
}

/// "nav" of "high_nav.csv".
std::string kind_of_csv(const std::string& stem) {
  return stem.substr(stem.rfind('_') + 1);
}

std::string wrong_in_file(const fs::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".pcd") return wrong_in_cloud(path.string());
  if (extension == ".tape") return wrong_in_tape(path.string());
  if (extension != ".csv" && extension != ".json" && extension != ".html") return "";
  const auto text = read_text_file(path.string());
  if (!text) return text.error().str();
  if (extension == ".csv") return not_finite_in_csv(*text, kind_of_csv(path.stem().string()));
  if (extension == ".json") return not_finite_in_json(*text, path.filename().string());
  return page_holds_no_number(*text) ? "a number that is not finite" : "";
}

}  // namespace

std::string not_finite_in_csv(std::string_view text, std::string_view kind) {
  if (!text.ends_with('\n')) return "the last line has no end";
  const auto lines = pieces(text.substr(0, text.size() - 1), '\n');
  const auto columns = pieces(lines.front(), ',');
  for (std::size_t i = 1; i < lines.size(); ++i)
    if (const auto wrong = wrong_in_row(columns, pieces(lines[i], ','), kind); !wrong.empty())
      return std::to_string(i + 1) + ": " + wrong;
  return "";
}

std::string not_finite_in_json(const std::string& text, std::string_view kind) {
  const auto tree = parse_json(text, std::string(kind));
  return tree ? wrong_in_tree(*tree, kind, "") : tree.error().str();
}

std::string not_finite_in_results(const fs::path& directory) {
  std::error_code code;
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator at(directory, code), end; !code && at != end; at.increment(code))
    if (at->is_regular_file(code)) files.push_back(at->path());
  if (code) return "left no " + directory.filename().string() + ": " + code.message();
  std::ranges::sort(files);
  for (const fs::path& file : files)
    if (const auto wrong = wrong_in_file(file); !wrong.empty()) return file.filename().string() + ": " + wrong;
  for (const char* needed : {"summary.json", "manifest.json"})
    if (!fs::is_regular_file(directory / needed, code)) return std::string("left no ") + needed;
  return "";
}

}  // namespace canyon::study
