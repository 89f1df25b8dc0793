#include "canyon/report/maps/map_raster.h"

#include <algorithm>

#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"
#include "canyon/report/maps/png.h"

namespace canyon::report {

CellBox occupied_box(const MapGrid& grid, const std::vector<const CloudSummary*>& clouds) {
  std::size_t left = grid.columns, right = 0, top = grid.rows, bottom = 0;
  for (const CloudSummary* cloud : clouds) {
    for (std::size_t row = 0; row < grid.rows; ++row) {
      for (std::size_t column = 0; column < grid.columns; ++column) {
        if (cloud->cell_rms_m[row * grid.columns + column] < 0) continue;
        left = std::min(left, column), right = std::max(right, column + 1);
        top = std::min(top, row), bottom = std::max(bottom, row + 1);
      }
    }
  }
  if (right == 0) return {};
  constexpr std::size_t kMargin = 8;
  left -= std::min(left, kMargin), top -= std::min(top, kMargin);
  right = std::min(grid.columns, right + kMargin), bottom = std::min(grid.rows, bottom + kMargin);
  return {left, top, right - left, bottom - top};
}

MapWindow window_of(const MapGrid& grid, const CellBox& box) {
  const auto at = [&](std::size_t column, std::size_t row_from_south) {
    return Eigen::Vector2d(
        grid.min_W + grid.cell_m * Eigen::Vector2d(static_cast<double>(column), static_cast<double>(row_from_south)));
  };
  return {at(box.column, grid.rows - box.row - box.rows), at(box.column + box.columns, grid.rows - box.row)};
}

std::string draw_cloud(const MapDrawing& map, const MapGrid& grid, const CellBox& box, const CloudSummary& cloud,
                       std::size_t shrink) {
  const std::size_t width = (box.columns + shrink - 1) / shrink, height = (box.rows + shrink - 1) / shrink;
  std::vector<std::uint8_t> pixels(width * height, 0);
  for (std::size_t row = 0; row < box.rows; ++row) {
    for (std::size_t column = 0; column < box.columns; ++column) {
      const float rms_m = cloud.cell_rms_m[(box.row + row) * grid.columns + box.column + column];
      if (rms_m < 0) continue;
      std::uint8_t& pixel = pixels[row / shrink * width + column / shrink];
      pixel = std::max(pixel, static_cast<std::uint8_t>(1 + map_error_classes().of(rms_m)));
    }
  }
  const MapWindow window = window_of(grid, box);
  const std::string corner = map.point({window.min_W.x(), window.max_W.y()}, 3);
  const std::size_t gap = corner.find(' ');
  const double cell_m = grid.cell_m * static_cast<double>(shrink);
  const std::string frame = "x=\"" + corner.substr(0, gap) + "\" y=\"" + corner.substr(gap + 1) + "\" width=\"" +
                            fixed(cell_m * static_cast<double>(width), 3) + "\" height=\"" +
                            fixed(cell_m * static_cast<double>(height), 3) + "\" preserveAspectRatio=\"none\"";
  std::string out;
  for (const bool dark : {false, true}) {
    out += std::string("<image class=\"only-") + (dark ? "dark" : "light") + "\" " + frame + " href=\"" +
           png_data_uri(write_indexed_png(width, height, pixels, map_palette(dark))) + "\"/>\n";
  }
  return out;
}

std::string map_error_legend() {
  const ErrorClasses& classes = map_error_classes();
  std::string out = "<p class=\"legend\"><span class=\"legend-title\">RMS error of the points over a square, m</span>";
  for (std::size_t k = 0; k < classes.labels.size(); ++k) {
    out += "<span class=\"key\"><svg class=\"chip\" viewBox=\"0 0 12 12\" aria-hidden=\"true\"><path style=\"fill:" +
           error_colour(k, classes.labels.size()) + "\" d=\"M0 0H12V12H0Z\"/></svg>" + classes.labels[k] + "</span>";
  }
  return out + "</p>\n";
}

}  // namespace canyon::report
