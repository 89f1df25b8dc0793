#pragma once

#include <string>
#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/result.h"

namespace canyon {

/// Values on a regular grid in W, by rows from the south; NaN = no value.
struct Grid {
  int columns = 0, rows = 0;
  double cell_m = 1.0;
  double west_m = 0.0, south_m = 0.0;  ///< lower left corner of the lower left cell
  std::vector<double> values;          ///< rows x columns

  double& at(int column, int row) { return values[index(column, row)]; }
  double at(int column, int row) const { return values[index(column, row)]; }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
};

/// An ESRI ASCII grid (.asc): header, then rows from the north; NODATA is -9999. `decimals` after the point.
std::string ascii_grid_text(const Grid& grid, int decimals);

/// What a GIS needs beside it (.prj): W's plane as an orthographic projection centred at W's origin, in the WKT that
/// ESRI's programs and GDAL read. Exact for points at the height of the origin.
std::string projection_text(const LocalFrame& frame);

}  // namespace canyon
