#pragma once

#include <string>

#include "canyon/report/read/results.h"

/// The sections of the page in their order. Each takes the runs in the order asked for, the mixed ones last
/// (html_report.cpp sees to it), and gives markup; what the results do not hold becomes a note.
namespace canyon::report {

std::string headline(const Results& results);            ///< the page's first line, plain text
std::string verdict_section(const Results& results);     ///< a sentence per run
std::string figures_section(const Results& results);     ///< the table
std::string loops_section(const Results& results);       ///< empty where one loop alone was driven
std::string scene_section(const Results& results);       ///< from above, and where it went wrong
std::string error_section(const Results& results);       ///< position error against time
std::string filter_section(const Results& results);      ///< does the filter know how wrong it is
std::string satellites_section(const Results& results);  ///< GDOP, satellites, NLOS share
std::string multipath_section(const Results& results);
std::string maps_section(const Results& results);  ///< the maps' point errors
std::string registration_section(const Results& results);
std::string two_by_two_section(const Results& results);  ///< empty for one run, which nothing stands beside
std::string seeds_section(const Results& results);       ///< empty for a single seed
std::string cost_section(const Results& results);
std::string provenance_section(const Results& results);  ///< how it was made, and the words used

}  // namespace canyon::report
