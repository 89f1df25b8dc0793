#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace canyon {

/// A to Z become a to z.
inline std::string lower_case(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

}  // namespace canyon
