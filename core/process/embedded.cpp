#include "canyon/core/process/embedded.h"

#include <algorithm>

/// What the generated table is made of; it declares the arrays of the generated sources, hence global scope.
struct EmbeddedRow {
  const char* key;
  const unsigned char* bytes;
  unsigned long size;
};

#include "embedded/table.inc"  // kEmbeddedRows, ended by a row without bytes

namespace canyon {

std::optional<std::string_view> embedded_file(std::string_view key) {
  for (const EmbeddedRow* row = kEmbeddedRows; row->bytes != nullptr; ++row) {
    if (row->key == key) return std::string_view(reinterpret_cast<const char*>(row->bytes), row->size);
  }
  return std::nullopt;
}

std::vector<std::string_view> embedded_files(std::string_view prefix) {
  std::vector<std::string_view> keys;
  for (const EmbeddedRow* row = kEmbeddedRows; row->bytes != nullptr; ++row) {
    const std::string_view key = row->key;
    if (key.substr(0, prefix.size()) == prefix) keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

}  // namespace canyon
