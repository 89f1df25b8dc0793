#include "canyon/report/draw/time_charts.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "canyon/report/draw/html.h"
#include "canyon/report/format.h"
#include "canyon/report/read/run_story.h"

namespace canyon::report {

Chart time_chart(const Results& results, std::string id, std::string title) {
  Chart chart;
  chart.id = std::move(id);
  chart.title = std::move(title);
  chart.time = true;
  chart.x = Axis::seconds(0, last_epoch_s(results));
  chart.x_label = "time from start, s";
  for (const std::size_t i : pure_runs(results)) {
    const Run& run = results.runs[i];
    if (!run.failure || !std::isfinite(run.failure->t_s)) continue;
    chart.marks.push_back(
        {i, run.failure->t_s, "\xE2\x9C\x95 " + run.fidelity + " " + show_quantity(run.failure->t_s, "s")});
  }
  return chart;
}

Line column_line(const Results& results, std::size_t i, const EpochTable& table, std::string_view column,
                 Line::Style style) {
  return {.run = i, .name = results.runs[i].fidelity, .x = table["t_s"], .y = table[column], .style = style};
}

Axis error_axis(const std::vector<Line>& lines) {
  std::vector<double> errors_m;
  for (const Line& line : lines) {
    std::copy_if(line.y.begin(), line.y.end(), std::back_inserter(errors_m), [](double y) { return y > 0; });
  }
  constexpr double kSmallest_m = 1e-3;
  if (errors_m.empty()) return Axis::logarithmic(0.01, 1);
  std::sort(errors_m.begin(), errors_m.end());
  const double low_m = std::max(errors_m[errors_m.size() / 200], kSmallest_m);
  return Axis::logarithmic(low_m, std::max(errors_m.back(), 2 * low_m));
}

std::string missing_file(const Run& run, std::string_view what, std::string_view suffix) {
  return "Run " + run.fidelity + " is not drawn: the results hold no " + std::string(what) + " of it (epochs/" +
         run.fidelity + std::string(suffix) + ").";
}

}  // namespace canyon::report
