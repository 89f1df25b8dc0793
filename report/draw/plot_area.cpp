#include "canyon/report/draw/plot_area.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "canyon/report/draw/decimate.h"
#include "canyon/report/format.h"

namespace canyon::report {
namespace {

bool shows(GridTicks ticks, const Tick& tick) {
  return ticks == GridTicks::kAll || (ticks == GridTicks::kLabelled) != tick.label.empty();
}

}  // namespace

double PlotArea::x_px(double value) const {
  return left + width * x.place(value);
}

double PlotArea::y_px(double value) const {
  // Far outside the frame it does not matter where; browsers clip large coordinates badly.
  return std::clamp(top + (1 - y.place(value)) * height, top - beyond, top + height + beyond);
}

std::string line_path(const PlotArea& area, const Line& line, std::size_t buckets) {
  std::string path;
  const auto point = [&](std::size_t i) {
    return fixed(area.x_px(line.x[i]), 1) + " " + fixed(area.y_px(line.y[i]), 2) + " ";
  };
  for (const LinePiece& piece : decimate(line.x, line.y, buckets)) {
    double last_y_px = 0;
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const std::size_t i = piece[k];
      if (k > 0 && line.style == Line::Style::kStep)
        path += fixed(area.x_px(line.x[i]), 1) + " " + fixed(last_y_px, 2) + " ";
      const bool begins = k == 0 || line.style == Line::Style::kPoints;
      path += (begins ? "M" : "") + point(i);
      if (line.style == Line::Style::kPoints) path.back() = 'h', path += "0 ";
      last_y_px = area.y_px(line.y[i]);
    }
    if (piece.size() == 1 && line.style != Line::Style::kPoints)
      path +=
          fixed(area.x_px(line.x[piece[0]]) + 0.1, 1) + " " + fixed(last_y_px, 2) + " ";  // a dot, by its round caps
  }
  if (!path.empty()) path.pop_back();
  return path;
}

std::string band_path(const PlotArea& area, const Band& band, std::size_t buckets) {
  // Both edges are drawn at the places that either needs, so the area closes and no spike of either is lost. Their gaps
  // are made the same, so their pieces are as well.
  std::vector<double> low = band.low, high = band.high;
  for (std::size_t i = 0; i < low.size(); ++i)
    if (!std::isfinite(low[i]) || !std::isfinite(high[i])) low[i] = high[i] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<LinePiece> lows = decimate(band.x, low, buckets), highs = decimate(band.x, high, buckets);
  std::string path;
  for (std::size_t k = 0; k < highs.size(); ++k) {
    LinePiece piece;
    std::set_union(lows[k].begin(), lows[k].end(), highs[k].begin(), highs[k].end(), std::back_inserter(piece));
    std::string forth, back;
    for (const std::size_t i : piece) {
      const std::string x = fixed(area.x_px(band.x[i]), 1) + " ";
      forth += x + fixed(area.y_px(band.high[i]), 1) + " ";
      back.insert(0, x + fixed(area.y_px(band.low[i]), 1) + " ");
    }
    if (!forth.empty()) path += "M" + forth + back + "Z";
  }
  return path;
}

std::string grid_path(const PlotArea& area, GridTicks ticks) {
  std::string path;
  for (const Tick& tick : area.y.ticks())
    if (shows(ticks, tick))
      path +=
          "M" + fixed(area.left, 2) + " " + fixed(area.y_px(tick.value), 2) + "H" + fixed(area.left + area.width, 2);
  for (const Tick& tick : area.x.ticks())
    if (shows(ticks, tick))
      path += "M" + fixed(area.x_px(tick.value), 2) + " " + fixed(area.top, 2) + "V" +
              fixed(area.top + area.height + area.foot, 2);
  return path;
}

}  // namespace canyon::report
