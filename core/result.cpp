#include "core/result.h"

namespace canyon {

std::string Error::str() const {
  std::string text;
  if (!file.empty()) {
    text += file;
    if (line > 0) text += ":" + std::to_string(line);
    text += ": ";
  }
  if (!key.empty()) text += key + ": ";
  text += what;
  if (!expected.empty()) text += ", expected " + expected;
  return text;
}

}  // namespace canyon
