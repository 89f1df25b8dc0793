#pragma once

#include <string>
#include <vector>

#include "canyon/report/draw/chart.h"
#include "canyon/report/read/results.h"

namespace canyon::report {

/// A chart over mission time that all runs fit on, with the runs' failures marked.
Chart time_chart(const Results& results, std::string id, std::string title);

/// A column of a table as a line of run i.
Line column_line(const Results& results, std::size_t i, const EpochTable& table, std::string_view column,
                 Line::Style style = Line::Style::kNormal);

/// A logarithmic axis for errors: up to the greatest, down to what all but one in two hundred exceed, but not below a
/// millimetre. A run starts with next to no error, and an axis that reached down there would show nothing else.
Axis error_axis(const std::vector<Line>& lines);

/// What is said where a run has no such file.
std::string missing_file(const Run& run, std::string_view what, std::string_view suffix);

}  // namespace canyon::report
