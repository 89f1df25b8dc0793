#pragma once

#include <string_view>
#include <vector>

namespace canyon::gnss {

/// Cells of an embedded table, without its comments (#), blank lines and heading. Throws if it is not embedded, or if a
/// row has another number of cells than the heading.
std::vector<std::vector<std::string_view>> table_rows(const char* key);

/// The number in a cell; throws if it is none.
double table_number(std::string_view cell);

}  // namespace canyon::gnss
