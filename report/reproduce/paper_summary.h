#pragma once

#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/result.h"
#include "canyon/core/units.h"

/// summary.json of `canyon reproduce`, as the page needs it. Undefined numbers are NaN.
namespace canyon::report {

struct PaperOurs {
  std::string form;
  double value = kNaN, low = kNaN, high = kNaN, n = kNaN;
};

struct PaperNumber {
  std::string what, unit, nearest;
  double paper = kNaN, real = kNaN, ratio = kNaN;
  std::vector<PaperOurs> ours;
};

struct PaperLine {
  std::string panel, unit, name;
  std::vector<double> x, y;
  bool points = false, from_above = false;
  std::vector<std::string> labels;  ///< of the first points; empty: none
};

struct PaperSection {
  std::string name, title, paper_says, made, x_label;
  std::vector<std::string> difference;
  std::vector<PaperNumber> rows;
  std::vector<PaperLine> curves;
};

struct PaperSummary {
  std::string ephemeris, start;
  double draws = kNaN, missions = kNaN;
  std::vector<PaperSection> parts;
};

Result<PaperSummary> read_paper_summary(const std::string& path);

}  // namespace canyon::report
