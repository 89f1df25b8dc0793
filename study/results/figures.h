#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "canyon/core/result.h"
#include "canyon/study/results/summary.h"

namespace canyon::study {

/// What is better of two values of a figure.
enum class Better { kLower, kHigher, kNeither };
const char* name(Better better);  ///< "lower", "higher", "neither"

/// A figure of a run, said once: summary.json, the terminal's table, the page, `--figures` and docs/results.md are made
/// from these rows. A new figure is one row of figures.cpp.
struct Figure {
  enum class Kind { kQuantity, kCount, kShare };  ///< shares are of 1, and shown in per cent

  const char* group;  ///< heading that it stands under
  const char* key;    ///< of a run in summary.json
  const char* unit;   ///< may be empty
  const char* label;
  Better better;
  Kind kind;
  int decimals;                      ///< in the terminal's table
  double (*get)(const RunSummary&);  ///< NaN where it is undefined
  const char* meaning = "";          ///< what the label leaves open; a [section] key in it is a key of the mission
  const char* total = nullptr;       ///< key of the figure that it is a part of: "27 of 590"
  double cap = std::numeric_limits<double>::infinity();  ///< values that reach it are known to be that or more
  Interval (*interval)(const RunSummary&) = nullptr;     ///< 95 %, of the value
  bool timing = false;                                   ///< depends on the machine: stands under `timing`
};

std::span<const Figure> figures();
/// nullptr if there is none of that key.
const Figure* find_figure(std::string_view key);

/// Rows by their keys; of no keys all but those that only say what others are a part of. An Error, for `option`, names
/// the nearest.
Result<std::vector<const Figure*>> choose_figures(const std::vector<std::string>& keys, const std::string& option);

/// A value and the interval that it came with, if any.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  Interval interval;
};
Estimate estimate(const Figure& figure, const RunSummary& run);

/// The run's figures, those under `timing` or the others, as members of `out`; undefined is null. Intervals stand under
/// `intervals`.
void write_figures(const RunSummary& run, bool timing, nlohmann::ordered_json& out);
/// A figure's value as summary.json has it.
nlohmann::ordered_json figure_json(const Figure& figure, double value);
/// What the figures are: `figures` of summary.json.
nlohmann::ordered_json figure_descriptions();
/// The same for people: the table of docs/results.md.
std::string figure_reference();

}  // namespace canyon::study
