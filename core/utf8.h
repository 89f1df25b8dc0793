#pragma once

#include <string>
#include <string_view>

namespace canyon {

/// The text as UTF-8: bytes that are none (RFC 3629) are each replaced by U+FFFD. For names out of files that may be
/// written in anything; JSON takes nothing else.
std::string valid_utf8(std::string_view text);

}  // namespace canyon
