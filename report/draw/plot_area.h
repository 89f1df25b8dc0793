#pragma once

#include <string>

#include "canyon/report/draw/chart.h"

namespace canyon::report {

/// A rectangle of a drawing and the axes that it spans: where values go, in the drawing's units, y downwards. What all
/// charts and pictures draw their curves with. The axes must live as long as the area.
struct PlotArea {
  const Axis& x;
  const Axis& y;
  double left = 0.0, top = 0.0, width = 0.0, height = 0.0;
  double beyond = 0.0;  ///< so far values may be drawn above and below the rectangle
  double foot = 0.0;    ///< so far upright grid lines go on beneath it

  double x_px(double value) const;
  double y_px(double value) const;
};

/// `d` attributes of SVG paths, thinned out to what can be seen in so many steps of x (report/draw/decimate.h): of a
/// band the extremes of both its edges. Where either edge is no number, a band has a gap.
std::string line_path(const PlotArea& area, const Line& line, std::size_t buckets);
std::string band_path(const PlotArea& area, const Band& band, std::size_t buckets);

/// Which ticks of both axes a grid shows.
enum class GridTicks { kAll, kLabelled, kUnlabelled };
std::string grid_path(const PlotArea& area, GridTicks ticks);

}  // namespace canyon::report
