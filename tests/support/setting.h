#pragma once

#include <cstdlib>
#include <string>

namespace canyon::testing {

/// An environment variable, by which a long test is run in another size or with other seeds; `otherwise`: without it.
inline std::string setting(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : otherwise;
}

}  // namespace canyon::testing
