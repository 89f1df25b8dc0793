#pragma once

#include <string>

namespace canyon::testing {

/// zlib's stream of a text; 16 + MAX_WBITS gives a gzip file.
std::string deflated(const std::string& text, int window_bits);
std::string gzipped(const std::string& text);

}  // namespace canyon::testing
