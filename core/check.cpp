#include "canyon/core/check.h"

#include <string_view>

namespace canyon {
namespace {

/// "core/time.cpp" of a full path: where the tree was built is of no use to the reader.
std::string_view short_path(std::string_view path) {
  const auto last = path.rfind('/');
  if (last == std::string_view::npos || last == 0) return path;
  const auto previous = path.rfind('/', last - 1);
  return previous == std::string_view::npos ? path : path.substr(previous + 1);
}

}  // namespace

void throw_failed_check(const char* condition, const char* file, int line, const std::string& values) {
  std::string message = join_values(short_path(file), ":", line, ": check failed: ", condition);
  if (!values.empty()) message += " (" + values + ")";
  throw ProgramError(message);
}

}  // namespace canyon
