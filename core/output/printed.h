#pragma once

#include <cstdio>
#include <string>

namespace canyon {

/// What printf would print, as a text.
template <class... Values>
std::string printed(const char* format, Values... values) {
  std::string out(static_cast<std::size_t>(std::snprintf(nullptr, 0, format, values...)), '\0');
  std::snprintf(out.data(), out.size() + 1, format, values...);
  return out;
}

}  // namespace canyon
