#include "canyon/report/draw/satellite_strips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "canyon/report/draw/html.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"

namespace canyon::report {
namespace {

constexpr std::size_t kBins = 500;
constexpr int kRow_px = 15;
constexpr int kCell_px = 9;
constexpr int kBlocked_px = 11;  // top of the line of a blocked path

/// What happened to one satellite during one bin of time; of several epochs the worst.
struct Cell {
  bool above = false, tracked = false, blocked = false;
  double multipath_m = 0.0;
};

using Rows = std::map<std::string, std::vector<Cell>>;

Rows gather(const EpochTable& table, const Axis& x, std::size_t bins) {
  Rows rows;
  for (std::size_t i = 0; i < table.rows; ++i) {
    const double place = x.place(table["t_s"][i]);
    if (place < 0 || place > 1) continue;
    std::vector<Cell>& row = rows.try_emplace(table.text("satellite")[i], bins).first->second;
    Cell& cell = row[std::min(static_cast<std::size_t>(place * static_cast<double>(bins)), bins - 1)];
    cell.above = true;
    if (!(table["tracked"][i] > 0)) continue;
    cell.tracked = true;
    if (table["line_of_sight"][i] == 0) cell.blocked = true;
    cell.multipath_m = std::max(cell.multipath_m, std::abs(table["multipath_m"][i]));
  }
  return rows;
}

/// Bars over runs of bins for which `accept` holds.
template <class Accept>
std::string bars(const std::vector<Cell>& row, double top_px, int height_px, Accept accept) {
  std::string path;
  const double bin_px = 1000.0 / static_cast<double>(row.size());
  for (std::size_t i = 0; i < row.size();) {
    if (!accept(row[i])) {
      ++i;
      continue;
    }
    const std::size_t first = i;
    while (i < row.size() && accept(row[i])) ++i;
    path += "M" + fixed(static_cast<double>(first) * bin_px, 1) + " " + fixed(top_px, 0) + "H" +
            fixed(static_cast<double>(i) * bin_px, 1) + "v" + std::to_string(height_px) + "H" +
            fixed(static_cast<double>(first) * bin_px, 1) + "z";
  }
  return path;
}

/// The number of epochs sets the bins where it is smaller: a bin without an epoch would look like a lost satellite.
std::size_t bins_for(const EpochTable& table, const Axis& x) {
  std::size_t epochs = 0;
  double last_s = -INFINITY, first_s = 0;
  for (const double t_s : table["t_s"]) {
    if (t_s == last_s) continue;
    if (epochs == 0) first_s = t_s;
    last_s = t_s;
    ++epochs;
  }
  if (epochs < 2) return 1;
  const double interval_s = (last_s - first_s) / static_cast<double>(epochs - 1);
  return std::clamp<std::size_t>(static_cast<std::size_t>((x.max() - x.min()) / interval_s), 1, kBins);
}

}  // namespace

std::string draw_satellite_strips(const Results& results, std::size_t run_number, const Axis& x) {
  const Run& run = results.runs[run_number];
  const Rows rows = gather(*run.satellites, x, bins_for(*run.satellites, x));
  const ErrorClasses& classes = multipath_classes();
  std::vector<std::string> paths(classes.labels.size());
  std::string above, blocked, labels;
  int index = 0;
  const int height_px = kRow_px * static_cast<int>(rows.size());
  for (const auto& [name, row] : rows) {
    const double top_px = index * kRow_px + 2;
    above += bars(row, top_px + kCell_px / 2, 1, [](const Cell& c) { return c.above && !c.tracked; });
    blocked += bars(row, index * kRow_px + kBlocked_px + 1, 2, [](const Cell& c) { return c.tracked && c.blocked; });
    for (std::size_t k = 0; k < paths.size(); ++k) {
      paths[k] +=
          bars(row, top_px, kCell_px, [&](const Cell& c) { return c.tracked && classes.of(c.multipath_m) == k; });
    }
    labels += "<span class=\"yt\" aria-hidden=\"true\" style=\"top:" +
              fixed(100 * (index * kRow_px + 0.5 * kRow_px) / height_px, 2) + "%\">" + escape_html(name) + "</span>\n";
    ++index;
  }
  const std::string id = "strips-" + std::to_string(run_number);
  std::string out = "<div class=\"chart " + run_class(run_number) + "\" data-time=\"\" data-x=\"" + fixed(x.min(), 9) +
                    " " + fixed(x.max(), 9) +
                    " lin\"><div class=\"panel\"><p class=\"panel-head\"><span>Multipath error by satellite, run " +
                    escape_html(run.fidelity) +
                    "<span class=\"unit\">, m</span></span></p>\n<div class=\"plot strips\" style=\"height:" +
                    std::to_string(height_px) + "px\"><svg viewBox=\"0 0 1000 " + std::to_string(height_px) +
                    "\" preserveAspectRatio=\"none\" role=\"img\" aria-labelledby=\"" + id + "-t " + id +
                    "-d\"><title id=\"" + id + "-t\">Multipath error by satellite over time, run " +
                    escape_html(run.fidelity) + "</title><desc id=\"" + id + "-d\">" + std::to_string(rows.size()) +
                    " satellites, a row each: colour by multipath error, a line beneath while the direct path is "
                    "blocked, blank while not "
                    "received.</desc>\n";
  std::string grid;
  for (const Tick& tick : x.ticks())
    grid += "M" + fixed(1000 * x.place(tick.value), 2) + " 0V" + std::to_string(height_px);
  out += "<path class=\"grid\" d=\"" + grid + "\"/><path class=\"untracked\" d=\"" + above + "\"/>\n";
  for (std::size_t k = 0; k < paths.size(); ++k) {
    if (!paths[k].empty())
      out += "<path style=\"fill:" + error_colour(k, paths.size()) + "\" d=\"" + paths[k] + "\"/>\n";
  }
  out += "<path class=\"blocked\" d=\"" + blocked + "\"/>\n</svg>\n" + labels +
         "</div></div>\n<div class=\"xaxis\" aria-hidden=\"true\">";
  for (const Tick& tick : x.ticks()) {
    out += "<span class=\"xt\" style=\"left:" + fixed(100 * x.place(tick.value), 2) + "%\">" + tick.label + "</span>";
  }
  return out + "</div><p class=\"xlabel\" aria-hidden=\"true\">time from start, s</p></div>\n";
}

std::string multipath_legend() {
  const ErrorClasses& classes = multipath_classes();
  std::string out = "<p class=\"legend\"><span class=\"legend-title\">|multipath error|, m</span>";
  for (std::size_t k = 0; k < classes.labels.size(); ++k) {
    out += "<span class=\"key\"><svg class=\"chip\" viewBox=\"0 0 12 12\" aria-hidden=\"true\"><path style=\"fill:" +
           error_colour(k, classes.labels.size()) + "\" d=\"M0 0H12V12H0Z\"/></svg>" + classes.labels[k] + "</span>";
  }
  out +=
      "<span class=\"key\"><svg class=\"chip wide\" viewBox=\"0 0 24 12\" aria-hidden=\"true\"><path class=\"blocked\" "
      "d=\"M0 5H24V7H0Z\"/></svg>direct "
      "path blocked</span><span class=\"key\"><svg class=\"chip wide\" viewBox=\"0 0 24 12\" "
      "aria-hidden=\"true\"><path class=\"untracked\" d=\"M0 "
      "5.5H24V6.5H0Z\"/></svg>above the mask, not received</span>";
  return out + "</p>\n";
}

}  // namespace canyon::report
