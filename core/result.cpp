#include "canyon/core/result.h"

#include "canyon/core/printable_text.h"

namespace canyon {
namespace {

/// Longer names no file has (PATH_MAX of Linux): it is damage, which is quoted as such.
constexpr std::size_t kLongestPath = 4096;

std::string file_name(const std::string& file) {
  if (file.size() > kLongestPath) return printable_text(file);
  std::string name = escaped_text(file);
  return name.size() > kLongestPath ? printable_text(file) : name;
}

}  // namespace

std::string Error::str() const {
  std::string text;
  if (!file.empty()) {
    text += file_name(file);
    if (line > 0) text += ":" + std::to_string(line);
    text += ": ";
  }
  if (!key.empty()) text += printable_text(key) + ": ";
  text += printable_text(what);
  if (!expected.empty()) text += ", expected " + printable_text(expected);
  return text;
}

}  // namespace canyon
