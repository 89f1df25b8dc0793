#include "canyon/gnss/satellites/csv_table.h"

#include <algorithm>
#include <charconv>

#include "canyon/core/check.h"
#include "canyon/core/process/embedded.h"

namespace canyon::gnss {
namespace {

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = std::min(line.find(','), line.size());
    cells.push_back(line.substr(0, comma));
    if (comma == line.size()) return cells;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

std::vector<std::vector<std::string_view>> table_rows(const char* key) {
  const auto text = embedded_file(key);
  CANYON_CHECK(text.has_value(), key, " is not embedded");
  std::vector<std::vector<std::string_view>> rows;
  std::size_t width = 0;
  for (std::size_t begin = 0; begin < text->size();) {
    const std::size_t end = std::min(text->find('\n', begin), text->size());
    const std::string_view line = text->substr(begin, end - begin);
    begin = end + 1;
    if (line.empty() || line.front() == '#') continue;
    auto cells = cells_of(line);
    const bool heading = width == 0;
    if (heading) width = cells.size();
    CANYON_CHECK(cells.size() == width, key, ": ", line);
    if (!heading) rows.push_back(std::move(cells));
  }
  return rows;
}

double table_number(std::string_view cell) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  CANYON_CHECK(error == std::errc() && end == cell.data() + cell.size(), "not a number: ", cell);
  return value;
}

}  // namespace canyon::gnss
