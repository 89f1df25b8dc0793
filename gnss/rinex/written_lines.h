#pragma once

#include <cstdio>
#include <string>

namespace canyon::gnss {

/// printf into a string, for the fields of a line; at most 199 characters.
std::string formatted(const char* format, auto... values) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

/// A header line: its content in 60 columns, then its label.
inline std::string labelled(std::string line, const char* label) {
  line.resize(60, ' ');
  return line + label + "\n";
}

}  // namespace canyon::gnss
