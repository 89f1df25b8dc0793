#pragma once

#include <span>
#include <string>
#include <string_view>

#include "canyon/report/read/results.h"

namespace canyon::report {

/// One line of the table: a figure of a run and how to show it.
struct FigureRow {
  enum class Kind { kQuantity, kCount, kShare };
  std::string_view group;
  std::string_view key;  ///< of summary.json's run; "timing.cpu_s" and the like inside its timing
  std::string_view label;
  std::string_view unit;
  Kind kind = Kind::kQuantity;
  std::string_view meaning;  ///< of the line, where no number of these results stands in it
  double cap = 0.0;          ///< if > 0: values that reach it are known to be that or more
};

/// All lines in the order of the table, groups together.
std::span<const FigureRow> figure_rows();

/// What a newcomer might ask of the line, with the numbers that hold in these results; may be empty.
std::string figure_meaning(const FigureRow& row, const Results& results);

/// The run's figure; NaN if undefined.
double figure_value(const Run& run, const FigureRow& row);

/// A key that summary.json must give as a number or null.
bool is_known_figure(std::string_view key);

}  // namespace canyon::report
