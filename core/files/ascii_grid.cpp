#include "canyon/core/files/ascii_grid.h"

#include <cmath>
#include <cstdio>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon {

std::string ascii_grid_text(const Grid& grid, int decimals) {
  CANYON_CHECK(grid.values.size() == static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows),
               grid.values.size(), " values for ", grid.columns, " x ", grid.rows);
  char buffer[256];
  std::snprintf(buffer, sizeof buffer,
                "ncols %d\nnrows %d\nxllcorner %.6f\nyllcorner %.6f\ncellsize %.6f\nNODATA_value -9999\n", grid.columns,
                grid.rows, grid.west_m, grid.south_m, grid.cell_m);
  std::string out = buffer;
  for (int row = grid.rows - 1; row >= 0; --row) {
    for (int column = 0; column < grid.columns; ++column) {
      const double value = grid.at(column, row);
      if (std::isfinite(value))
        std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
      else
        std::snprintf(buffer, sizeof buffer, "-9999");
      out += buffer;
      out += column + 1 < grid.columns ? ' ' : '\n';
    }
  }
  return out;
}

std::string projection_text(const LocalFrame& frame) {
  char buffer[640];
  std::snprintf(buffer, sizeof buffer,
                "PROJCS[\"Canyon_W\",GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,"
                "298.257223563]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],"
                "PROJECTION[\"Orthographic\"],PARAMETER[\"False_Easting\",0.0],PARAMETER[\"False_Northing\",0.0],"
                "PARAMETER[\"Longitude_Of_Center\",%.9f],PARAMETER[\"Latitude_Of_Center\",%.9f],UNIT[\"Meter\",1.0]]\n",
                frame.origin().lon_rad / kDegree, frame.origin().lat_rad / kDegree);
  return buffer;
}

}  // namespace canyon
