#include "canyon/report/read/epoch_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "canyon/core/messages.h"
#include "canyon/core/process/progress.h"
#include "canyon/report/read/number_limit.h"

namespace canyon::report {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Cuts the next line off `rest`.
std::string_view next_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  const std::string_view line = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  return line;
}

/// The fields of a line. A field in double quotes may hold commas and doubled quotes (RFC 4180).
void split_fields(std::string_view line, std::vector<std::string>& fields) {
  fields.clear();
  std::size_t i = 0;
  while (true) {
    std::string field;
    std::size_t start = line.find_first_not_of(" \t", i);
    if (start != std::string_view::npos && line[start] == '"') {
      for (i = start + 1; i < line.size(); ++i) {
        if (line[i] == '"') {
          if (i + 1 >= line.size() || line[i + 1] != '"') break;
          ++i;
        }
        field += line[i];
      }
      i = std::min(line.find(',', i), line.size());
    } else {
      const std::size_t end = std::min(line.find(',', i), line.size());
      field = std::string(trimmed(line.substr(i, end - i)));
      i = end;
    }
    fields.push_back(std::move(field));
    if (i >= line.size()) return;
    ++i;  // the comma
  }
}

bool parse_number(const std::string& field, double& value) {
  if (field.empty()) {
    value = kNaN;
    return true;
  }
  if (field == "true" || field == "false") {
    value = field == "true" ? 1 : 0;
    return true;
  }
  const auto [end, status] = std::from_chars(field.data(), field.data() + field.size(), value);
  return status == std::errc{} && end == field.data() + field.size() && std::isfinite(value);
}

}  // namespace

const std::vector<double>& EpochTable::operator[](std::string_view column) const {
  const auto found = numbers.find(column);
  CANYON_CHECK(found != numbers.end(), "column ", column, " was not read");
  return found->second;
}

const std::vector<std::string>& EpochTable::text(std::string_view column) const {
  const auto found = texts.find(column);
  CANYON_CHECK(found != texts.end(), "column ", column, " was not read");
  return found->second;
}

Result<EpochTable> parse_epoch_table(std::string_view csv, const std::string& file, const EpochColumns& columns) {
  std::vector<std::string> fields;
  std::string_view rest = csv;
  split_fields(next_line(rest), fields);
  const std::vector<std::string> header = fields;
  const auto position = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
  };

  struct NumberColumn {
    std::size_t at;
    const std::string* name;
    std::vector<double>* values;
  };
  EpochTable table;
  std::vector<NumberColumn> number_columns;
  std::vector<std::pair<std::size_t, std::vector<std::string>*>> text_columns;
  for (const std::string& name : columns.numbers) {
    if (position(name) == header.size()) return Error{file, 1, name, "column missing", "a column of that name"};
    number_columns.push_back({position(name), &name, &table.numbers[name]});
  }
  for (const std::string& name : columns.texts) {
    if (position(name) == header.size()) return Error{file, 1, name, "column missing", "a column of that name"};
    text_columns.emplace_back(position(name), &table.texts[name]);
  }

  double last_t_s = -INFINITY;
  for (int line_number = 2; !rest.empty(); ++line_number) {
    const std::string_view line = next_line(rest);
    if (line_number % 4096 == 0) throw_if_cancelled();
    if (trimmed(line).empty()) continue;
    split_fields(line, fields);
    if (fields.size() != header.size()) {
      return Error{file,
                   line_number,
                   {},
                   std::to_string(fields.size()) + " fields",
                   std::to_string(header.size()) + " as in the first line"};
    }
    for (const NumberColumn& column : number_columns) {
      double value = kNaN;
      if (!parse_number(fields[column.at], value)) {
        return Error{file, line_number, *column.name, "'" + fields[column.at] + "'",
                     "a finite number or an empty field"};
      }
      if (std::abs(value) > kLargestNumber)
        return Error{file, line_number, *column.name, "'" + fields[column.at] + "'",
                     "a number of at most 1e15 in size"};
      column.values->push_back(without_dust(value));
    }
    for (const auto& [at, values] : text_columns) values->push_back(fields[at]);
    ++table.rows;
    if (!columns.in_order) continue;
    const double t_s = table["t_s"].back();
    if (!(t_s >= last_t_s)) {
      return Error{file, line_number, "t_s", "'" + fields[position("t_s")] + "'", "times that do not run backwards"};
    }
    last_t_s = t_s;
  }
  return table;
}

}  // namespace canyon::report
