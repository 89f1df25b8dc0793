#include <algorithm>
#include <cmath>

#include "canyon/report/draw/html.h"
#include "canyon/report/draw/satellite_strips.h"
#include "canyon/report/draw/time_charts.h"
#include "canyon/report/format.h"
#include "canyon/report/sections/sections.h"

namespace canyon::report {

std::string multipath_section(const Results& results) {
  Panel largest{.title = "Largest multipath error of an epoch", .unit = "m"};
  largest.height_px = 110;
  std::string strips, missing;
  Chart chart = time_chart(results, "multipath-chart", "Multipath error against time");
  for (const std::size_t i : pure_runs(results)) {
    const Run& run = results.runs[i];
    if (run.gnss_epochs) {
      Line line = column_line(results, i, *run.gnss_epochs, "multipath_max_m");
      for (double& y : line.y) y = std::abs(y);
      if (extremes_of({line}).drawn) largest.lines.push_back(std::move(line));
    }
    if (run.satellites && run.satellites->rows > 0) {
      strips += draw_satellite_strips(results, i, chart.x);
    } else {
      missing += note("Run " + run.fidelity +
                      " has no satellites to show: its GNSS model has none, or the results hold no epochs/" +
                      run.fidelity + "_satellites.csv.");
    }
  }
  std::string body;
  if (!largest.lines.empty()) {
    std::vector<std::size_t> drawn;
    for (const Line& line : largest.lines) {
      drawn.push_back(line.run);
      chart.description += line.name + ": up to " + show_quantity(extremes_of({line}).max, "m") + ". ";
    }
    largest.y = Axis::linear_rounded(0, std::max(0.1, extremes_of(largest.lines).max), 4);
    chart.panels.push_back(std::move(largest));
    body += run_legend(results.runs, drawn) + figure(draw(chart), {});
  }
  if (!strips.empty()) body += multipath_legend() + "<figure>\n" + strips + "</figure>\n";
  return section("multipath", "Multipath",
                 body.empty() ? ""
                              : "The true error of a range that reflected signals cause, or the only signal there is "
                                "when the direct path is blocked.",
                 body + missing);
}

}  // namespace canyon::report
