#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "canyon/report/maps/map_drawing.h"
#include "canyon/report/read/cloud_summary.h"

namespace canyon::report {

/// A rectangle of cells of a MapGrid: the part of the scene that the maps reach.
struct CellBox {
  std::size_t column = 0, row = 0, columns = 0, rows = 0;
  bool empty() const { return columns == 0; }
};

/// The smallest box around all occupied cells of the clouds, and a margin of a few cells.
CellBox occupied_box(const MapGrid& grid, const std::vector<const CloudSummary*>& clouds);

MapWindow window_of(const MapGrid& grid, const CellBox& box);

/// The cloud's cells coloured by RMS error as SVG images over `box`, one for light and one for dark pages; every
/// `shrink` cells in both directions become one pixel, of their worst cell.
std::string draw_cloud(const MapDrawing& map, const MapGrid& grid, const CellBox& box, const CloudSummary& cloud,
                       std::size_t shrink);

/// The classes of map error as a legend.
std::string map_error_legend();

}  // namespace canyon::report
