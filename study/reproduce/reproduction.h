#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "canyon/core/units.h"
#include "canyon/study/statistics/interval.h"

/// Durst & Goodin 2012, table by table and figure by figure, beside what Canyon gives (docs/paper.md).
namespace canyon::study {

/// What a form of our models gives for a number of the paper: the median over draws, and the least and the most of
/// them, undefined of a single one; or, of missions over seeds, a share, a median or a difference with its 95 %
/// interval.
struct Ours {
  std::string form;  ///< "as printed"
  double value = kNaN;
  Interval range;
  std::int64_t n = 1;  ///< of so many values: draws (three each where three gyroscopes drift), or seeds that have it
};

/// One number of the paper with ours beside it.
struct PaperRow {
  std::string what;
  std::string unit;     ///< may be empty
  double paper = kNaN;  ///< of its model; NaN where the paper has it in a picture, or in words, alone
  double real = kNaN;   ///< of the real sensor that it measured; NaN where there was none
  std::vector<Ours> ours;
};

/// One line of a drawing, or its points.
struct PaperCurve {
  std::string panel, unit;  ///< panels are drawn over one another, in the order in which they first occur
  std::string name;
  std::vector<double> x, y;  ///< NaN cuts it
  bool points = false;
  bool from_above = false;               ///< x is east and y north, m: the panel is drawn to scale
  std::vector<std::string> labels = {};  ///< a word beside each point; empty: none
};

/// A table of the paper, or figures that belong together.
struct PaperPart {
  std::string name;                     ///< "table_1"
  std::string title;                    ///< "Table 1 and Fig. 1: what each range error alone moves the position by"
  std::string paper_says;               ///< the paper's own account
  std::string made;                     ///< how ours are made
  std::vector<std::string> difference;  ///< what differs, and why as far as it is known
  std::string x_label;                  ///< of panels that are not seen from above
  std::vector<PaperRow> rows;
  std::vector<PaperCurve> curves;
};

struct Reproduction {
  std::string ephemeris;      ///< which satellites the GNSS parts saw
  std::string start;          ///< of them, GPS time
  std::int64_t draws = 0;     ///< of each cheap number
  std::int64_t missions = 0;  ///< seeds of the missions; 0: none were driven
  std::vector<PaperPart> parts;
};

/// Our value nearest to the paper's by ratio; nullptr without a number of the paper, or without a defined one of ours.
const Ours* nearest(const PaperRow& row);

/// summary.json, which is also what --json prints: undefined values are null.
nlohmann::ordered_json reproduction_json(const Reproduction& reproduction);

/// paper.csv: one row per form of ours of every number.
std::string reproduction_csv(const Reproduction& reproduction);

/// For the terminal: each part's rows, ours beside the paper's.
std::string reproduction_table(const Reproduction& reproduction);

}  // namespace canyon::study
