#include "canyon/report/maps/raster_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/report/format.h"
#include "canyon/report/maps/png.h"

namespace canyon::report {
namespace {

constexpr double kMap = 600.0, kLeft = 20.0, kTop = 60.0;

// Nine steps of the viridis scale (van der Walt & Smith 2015), light to dark: dark is bad.
constexpr std::array<Rgba, 9> kViridis = {{{253, 231, 37, 255},
                                           {173, 220, 48, 255},
                                           {94, 201, 98, 255},
                                           {40, 174, 128, 255},
                                           {33, 145, 140, 255},
                                           {44, 114, 142, 255},
                                           {59, 82, 139, 255},
                                           {71, 45, 123, 255},
                                           {68, 1, 84, 255}}};

/// Colour of class k of n.
Rgba colour(const RasterMap& map, std::size_t k) {
  const std::size_t last = map.edges.size();
  const std::size_t step = last == 0 ? 0 : (k * (kViridis.size() - 1) + last / 2) / last;
  return kViridis[map.bad_is_low ? kViridis.size() - 1 - step : step];
}

std::string css(Rgba c) {
  return "rgb(" + std::to_string(c.r) + "," + std::to_string(c.g) + "," + std::to_string(c.b) + ")";
}

std::string label(const RasterMap& map, std::size_t k) {
  const std::string unit = map.unit.empty() ? "" : " " + map.unit;
  if (map.edges.empty()) return "all";
  if (k == 0) return "below " + fixed(map.edges.front(), 3) + unit;
  if (k == map.edges.size()) return fixed(map.edges.back(), 3) + unit + " and more";
  return fixed(map.edges[k - 1], 3) + " to " + fixed(map.edges[k], 3) + unit;
}

/// A round length of about a fifth of the map.
double scale_bar_m(double width_m) {
  const double wanted = width_m / 5.0, decade = std::pow(10.0, std::floor(std::log10(wanted)));
  for (const double step : {5.0, 2.0, 1.0})
    if (step * decade <= wanted) return step * decade;
  return decade;
}

}  // namespace

std::string raster_png(const RasterMap& map) {
  const Grid& grid = *map.grid;
  CANYON_CHECK(map.edges.size() < kViridis.size(), map.edges.size(), " edges");
  std::vector<Rgba> palette = {{0, 0, 0, 0}};
  for (std::size_t k = 0; k <= map.edges.size(); ++k) palette.push_back(colour(map, k));
  std::vector<std::uint8_t> pixels;
  pixels.reserve(grid.values.size());
  for (int row = grid.rows - 1; row >= 0; --row)
    for (int column = 0; column < grid.columns; ++column) {
      const double value = grid.at(column, row);
      const auto k = std::upper_bound(map.edges.begin(), map.edges.end(), value) - map.edges.begin();
      pixels.push_back(std::isfinite(value) ? static_cast<std::uint8_t>(1 + k) : std::uint8_t{0});
    }
  return write_indexed_png(static_cast<std::size_t>(grid.columns), static_cast<std::size_t>(grid.rows), pixels,
                           palette);
}

std::string raster_svg(const RasterMap& map) {
  const Grid& grid = *map.grid;
  const double width_m = grid.columns * grid.cell_m, height_m = grid.rows * grid.cell_m;
  const double px_per_m = kMap / std::max(width_m, height_m);
  const double w = width_m * px_per_m, h = height_m * px_per_m;
  const double page_w = kLeft + w + 200.0, page_h = kTop + h + 44.0;
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + fixed(page_w, 0) + " " +
                    fixed(page_h, 0) + "\" width=\"" + fixed(page_w, 0) + "\" height=\"" + fixed(page_h, 0) +
                    "\" font-family=\"system-ui, sans-serif\" font-size=\"12\" role=\"img\">\n<title>" +
                    escape_html(map.title) + "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
                    "<text x=\"20\" y=\"26\" font-size=\"16\" font-weight=\"600\">" + escape_html(map.title) +
                    "</text>\n<text x=\"20\" y=\"46\" fill=\"#444\">" + escape_html(map.subtitle) + "</text>\n";
  out += "<rect x=\"20\" y=\"60\" width=\"" + fixed(w, 1) + "\" height=\"" + fixed(h, 1) + "\" fill=\"#c9c4bb\"/>\n" +
         "<image x=\"20\" y=\"60\" width=\"" + fixed(w, 1) + "\" height=\"" + fixed(h, 1) +
         "\" preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" href=\"" + png_data_uri(raster_png(map)) +
         "\"/>\n";
  double y = kTop + 8.0;
  for (std::size_t k = 0; k <= map.edges.size(); ++k, y += 22.0)
    out += "<rect x=\"" + fixed(kLeft + w + 18.0, 1) + "\" y=\"" + fixed(y, 1) +
           "\" width=\"14\" height=\"14\" fill=\"" + css(colour(map, k)) + "\"/><text x=\"" +
           fixed(kLeft + w + 40.0, 1) + "\" y=\"" + fixed(y + 11.5, 1) + "\">" + escape_html(label(map, k)) +
           "</text>\n";
  out += "<rect x=\"" + fixed(kLeft + w + 18.0, 1) + "\" y=\"" + fixed(y, 1) +
         "\" width=\"14\" height=\"14\" fill=\"#c9c4bb\"/><text x=\"" + fixed(kLeft + w + 40.0, 1) + "\" y=\"" +
         fixed(y + 11.5, 1) + "\">building, or no value</text>\n";
  const double bar_m = scale_bar_m(width_m), bar_px = bar_m * px_per_m, foot = kTop + h + 18.0;
  out += "<path d=\"M20 " + fixed(foot, 1) + "h" + fixed(bar_px, 1) +
         "\" stroke=\"#222\" stroke-width=\"3\"/><text x=\"" + fixed(28.0 + bar_px, 1) + "\" y=\"" +
         fixed(foot + 4.0, 1) + "\">" + show_quantity(bar_m, "m") + ", north up</text>\n</svg>\n";
  return out;
}

}  // namespace canyon::report
