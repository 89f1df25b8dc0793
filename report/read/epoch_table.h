#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/result.h"

namespace canyon::report {

/// The columns of an epochs/*.csv file that the report draws. An empty field is NaN (numbers) or "" (texts).
struct EpochTable {
  std::map<std::string, std::vector<double>, std::less<>> numbers;
  std::map<std::string, std::vector<std::string>, std::less<>> texts;
  std::size_t rows = 0;

  const std::vector<double>& operator[](std::string_view column) const;
  const std::vector<std::string>& text(std::string_view column) const;
};

/// Which columns to read. Further columns of the file are skipped; a listed one that is missing is an error, as are a
/// field that is not a finite number, a row with too few or too many fields, and times that run backwards.
struct EpochColumns {
  std::vector<std::string> numbers;  ///< `true` and `false` are read as 1 and 0
  std::vector<std::string> texts;
  bool in_order = true;  ///< else t_s need not be there, and times may run backwards
};

/// `file` is named in errors. The first line holds the column names; t_s must be among the numbers of a table in order.
Result<EpochTable> parse_epoch_table(std::string_view csv, const std::string& file, const EpochColumns& columns);

}  // namespace canyon::report
