#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "canyon/report/draw/axis.h"

/// Charts as SVG that stretches to the page's width, with its words in HTML beside it: so they stay readable on a phone
/// and in print. All texts given here are plain; they are escaped when drawn.
namespace canyon::report {

/// A line; NaN cuts it.
struct Line {
  std::size_t run = 0;    ///< gives the colour
  std::string name = {};  ///< in the read-out: "high", "high, prior"
  std::vector<double> x = {}, y = {};
  enum class Style { kNormal, kThin, kStep, kPoints } style = Style::kNormal;
  bool whole =
      false;  ///< every point is drawn, and x may come and go; else thinned out along x (report/draw/decimate.h)
};

/// The area between two lines.
struct Band {
  std::size_t run = 0;
  std::vector<double> x = {}, low = {}, high = {};
};

/// A lane at the foot of a panel with bars over intervals of x.
struct Lane {
  std::size_t run = 0;
  std::string name;
  std::vector<std::pair<double, double>> intervals = {};
};

/// An upright line over all panels, with words at its top.
struct Mark {
  std::size_t run = 0;
  double x = 0.0;
  std::string text;
};

/// Words beside a place of a panel; they step aside for one another.
struct PointLabel {
  std::size_t run = 0;
  double x = 0.0, y = 0.0;
  std::string text = {};
};

struct Panel {
  std::string title = {};  ///< "East error"
  std::string unit = {};   ///< "m"; may be empty
  Axis y = Axis::linear(0, 1);
  int height_px = 120;
  bool zero_line = false;
  std::optional<double> limit = {};  ///< a level line across the panel
  std::vector<Band> bands = {};
  std::vector<Line> lines = {};
  std::vector<Lane> lanes = {};
  std::vector<PointLabel> labels = {};
  std::optional<std::size_t> marks_of = {};  ///< the only run whose marks the panel shows; none = all runs
  std::vector<std::string> notes = {};       ///< beneath the panel: what is missing and why
};

/// Panels over one another with one x axis.
struct Chart {
  std::string id;  ///< of the HTML element; letters, digits, '-'
  Axis x = Axis::linear(0, 1);
  std::string x_label;      ///< "time from start, s"
  bool solid = false;       ///< no dashes: each panel shows one run
  bool time = false;        ///< x is mission time: the cursor is shared with all such charts and the map
  std::string title;        ///< for screen readers
  std::string description;  ///< for screen readers: what there is to see, in numbers
  std::vector<Panel> panels;
  std::vector<Mark> marks;
};

std::string draw(const Chart& chart);

/// The interval that holds the finite values of all lines, or [fallback_min, fallback_max]; `drawn` tells whether there
/// are any.
struct Extremes {
  double min = 0.0, max = 1.0;
  bool drawn = false;
};
Extremes extremes_of(const std::vector<Line>& lines);
/// The same over values above zero only, for a logarithmic axis.
Extremes positive_extremes_of(const std::vector<Line>& lines);

}  // namespace canyon::report
