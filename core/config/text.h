#pragma once

#include <string>

#include "canyon/core/config/config.h"

namespace canyon {

/// The shortest decimal text that reads back as the same number: 500, 0.1, 1e-09, nan.
std::string number_text(double value);

/// What a range demands, for messages and documentation: "a number from 0.1 to 20", "a positive whole number".
std::string range_text(Range range, bool whole);

/// a, b, c
std::string plain_list(const std::vector<std::string>& words);
/// "a", "b", "c".
std::string quoted_list(const std::vector<std::string>& words);

}  // namespace canyon
