#pragma once

#include <string>
#include <string_view>

#include "canyon/core/result.h"

namespace canyon {

Result<std::string> read_text_file(const std::string& path);
/// Like read_text_file, but gzip files are unpacked (zlib), whatever their name.
Result<std::string> read_text_or_gzip_file(const std::string& path);
Status write_text_file(const std::string& path, std::string_view text);

/// SHA-256 of bytes as 64 hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

}  // namespace canyon
