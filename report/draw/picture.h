#pragma once

#include <string>
#include <vector>

#include "canyon/report/draw/chart.h"

namespace canyon::report {

/// Panels as one SVG file of its own, on white, for whatever shows pictures. Runs give the colours; lines with a name
/// stand in the legend. Lanes, limits and notes are the page's.
struct Picture {
  std::string title, subtitle = {};
  Axis x = Axis::linear(0, 1);  ///< of all panels
  std::string x_label;
  bool side_by_side = false;  ///< large panels in a row; else flat ones over one another
  std::vector<Panel> panels;
};
std::string picture_svg(const Picture& picture);

/// Panels over one another over time, in seconds from the start, all axes linear around what is drawn.
Picture time_picture(std::string title, std::vector<Panel> panels);

/// Panels side by side over averaging time, all axes logarithmic in whole decades around lines and bands.
Picture deviation_picture(std::string title, std::string subtitle, std::vector<Panel> panels);

}  // namespace canyon::report
