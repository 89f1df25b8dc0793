#pragma once

#include <string>
#include <vector>

#include "canyon/core/files/ascii_grid.h"

namespace canyon::report {

/// Values over an area, seen from above, in classes of colour.
struct RasterMap {
  std::string title, subtitle, unit;
  const Grid* grid = nullptr;
  std::vector<double> edges;  ///< rising: class 0 below edges[0], ..., the last from edges.back() on; at most 8 edges
  bool bad_is_low = false;    ///< few satellites are bad, a small error is good: bad is drawn dark
};

/// One pixel a cell, north up; cells without value are transparent.
std::string raster_png(const RasterMap& map);
/// The same with title, legend, and a scale, as one self-contained SVG.
std::string raster_svg(const RasterMap& map);

}  // namespace canyon::report
