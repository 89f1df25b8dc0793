#include "canyon/core/result.h"

#include "canyon/core/printable_text.h"

namespace canyon {

std::string Error::str() const {
  std::string text;
  if (!file.empty()) {
    text += escaped_text(file);
    if (line > 0) text += ":" + std::to_string(line);
    text += ": ";
  }
  if (!key.empty()) text += printable_text(key) + ": ";
  text += printable_text(what);
  if (!expected.empty()) text += ", expected " + printable_text(expected);
  return text;
}

}  // namespace canyon
