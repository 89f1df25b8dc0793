#pragma once

#include <string>
#include <vector>

#include "canyon/report/read/results.h"

/// How the page shows the figures that summary.json describes.
namespace canyon::report {

/// Those that have a line of their own: all but such as only say what others are a part of.
std::vector<const Figure*> shown_figures(const Results& results);

/// What a newcomer might ask of the line, with the numbers that hold in these results; may be empty.
std::string figure_meaning(const Figure& figure, const Results& results);

/// The value as the table shows it, without its unit; an en dash where it is undefined.
std::string show_figure(const Figure& figure, double value);
/// "0.141 to 0.152"; empty without an interval.
std::string show_interval(const Figure& figure, const Interval& interval);
/// It is known to be the cap or more.
bool at_cap(const Figure& figure, double value);

/// A cell of a table.
std::string figure_cell(const std::string& text, bool undefined);
/// What stands beside the values: the unit, and which of two values is better.
std::string unit_cell(const Figure& figure);

}  // namespace canyon::report
