#include <algorithm>
#include <cmath>

#include "canyon/core/messages.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/time_charts.h"
#include "canyon/report/format.h"
#include "canyon/report/read/run_story.h"
#include "canyon/report/sections/sections.h"

namespace canyon::report {
namespace {

bool any_defined(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// A GNSS model that adds noise to truth knows neither geometry nor signals.
bool has_satellites(const EpochTable& gnss) {
  const std::vector<double>& tracked = gnss["tracked"];
  return any_defined(gnss["gdop"]) || std::any_of(tracked.begin(), tracked.end(), [](double n) { return n > 0; });
}

/// Half the usual distance of epochs to both sides, so that neighbouring epochs join.
double half_interval_s(const EpochTable& gnss) {
  const std::vector<double>& t = gnss["t_s"];
  return gnss.rows < 2 ? 0.5 : 0.5 * (t.back() - t.front()) / static_cast<double>(gnss.rows - 1);
}

Lane without_fix(const Results& results, std::size_t i) {
  const EpochTable& gnss = *results.runs[i].gnss_epochs;
  Lane lane{.run = i, .name = results.runs[i].fidelity + ": no fix", .intervals = {}};
  const double half_s = half_interval_s(gnss);
  for (std::size_t k = 0; k < gnss.rows; ++k) {
    if (gnss.text("status")[k] != "none") continue;
    const double from = gnss["t_s"][k] - half_s, to = gnss["t_s"][k] + half_s;
    if (!lane.intervals.empty() && from <= lane.intervals.back().second + 1e-6) {
      lane.intervals.back().second = to;
    } else {
      lane.intervals.emplace_back(from, to);
    }
  }
  return lane;
}

Line nlos_line(const Results& results, std::size_t i) {
  const EpochTable& gnss = *results.runs[i].gnss_epochs;
  Line line{.run = i, .name = results.runs[i].fidelity, .x = gnss["t_s"], .y = {}, .style = Line::Style::kStep};
  for (std::size_t k = 0; k < gnss.rows; ++k) {
    const double tracked = gnss["tracked"][k];
    line.y.push_back(tracked > 0 ? 100 * gnss["nlos"][k] / tracked : kNaN);
  }
  return line;
}

/// What a run's satellites were like, for the caption.
std::string summary_of(const Results& results, std::size_t i) {
  const Run& run = results.runs[i];
  const EpochTable& gnss = *run.gnss_epochs;
  std::size_t lost = 0, accepted = 0, fixes = 0;
  for (std::size_t k = 0; k < gnss.rows; ++k) {
    if (gnss.text("status")[k] == "none") {
      ++lost;
      continue;
    }
    ++fixes;
    accepted += gnss["accepted"][k] > 0 ? 1 : 0;
  }
  std::string text = run_tag(results.runs, i) + " " + count_of(static_cast<double>(gnss.rows), "epoch", "epochs") +
                     ", " + show_count(static_cast<double>(lost)) + " without a fix";
  if (fixes > 0 && any_defined(gnss["accepted"])) {
    text += "; the filter accepted " + show_share(static_cast<double>(accepted) / static_cast<double>(fixes)) +
            " of the fixes";
  }
  return text + ".";
}

}  // namespace

std::string satellites_section(const Results& results) {
  Panel gdop{.title = "GDOP (logarithmic)"};
  Panel satellites{.title = "Satellites used in the fix"};
  Panel nlos{.title = "Tracked satellites whose direct path is blocked", .unit = "%"};
  std::vector<std::size_t> drawn;
  std::string caption, missing;
  for (const std::size_t i : pure_runs(results)) {
    const Run& run = results.runs[i];
    if (!run.gnss_epochs || run.gnss_epochs->rows == 0) {
      missing += note(missing_file(run, "GNSS epochs", "_gnss.csv"));
      continue;
    }
    const EpochTable& gnss = *run.gnss_epochs;
    caption += (caption.empty() ? "" : "<br>") + summary_of(results, i);
    if (Lane lane = without_fix(results, i); !lane.intervals.empty()) gdop.lanes.push_back(std::move(lane));
    drawn.push_back(i);
    if (!has_satellites(gnss)) {
      missing +=
          note("Run " + run.fidelity + " has no satellites: its GNSS model makes each fix out of truth and noise.");
      continue;
    }
    gdop.lines.push_back(column_line(results, i, gnss, "gdop"));
    satellites.lines.push_back(column_line(results, i, gnss, "satellites", Line::Style::kStep));
    nlos.lines.push_back(nlos_line(results, i));
  }
  const std::string title = "Satellite geometry against time";
  if (gdop.lines.empty()) {
    const bool told =
        !missing.empty() && !caption.empty();  // fixes without satellites: no chart, but how many there were
    return section("satellites", title, {}, missing + (told ? "<p class=\"intro\">" + caption + "</p>\n" : ""));
  }

  Chart chart = time_chart(results, "gdop-chart", title);
  const Extremes e = positive_extremes_of(gdop.lines);
  gdop.y = Axis::logarithmic(e.drawn ? e.min : 1, e.drawn ? std::max(e.max, 1.5 * e.min) : 10);
  gdop.height_px = 140;
  satellites.y = Axis::linear_rounded(0, std::max(4.0, extremes_of(satellites.lines).max), 4);
  satellites.height_px = 90;
  nlos.y = Axis::linear(0, std::max(10.0, 10 * std::ceil(extremes_of(nlos.lines).max / 10)), 4);
  nlos.height_px = 80;
  for (const Line& line : gdop.lines) {
    const Extremes g = extremes_of({line});
    if (g.drawn)
      chart.description += line.name + ": GDOP from " + show_number(g.min) + " to " + show_number(g.max) + ". ";
  }
  std::vector<std::size_t> shown;  // in the legend
  for (const std::size_t i : drawn) {
    const auto of_run = [i](const auto& item) { return item.run == i; };
    if (std::any_of(gdop.lines.begin(), gdop.lines.end(), of_run) ||
        std::any_of(gdop.lanes.begin(), gdop.lanes.end(), of_run)) {
      shown.push_back(i);
    }
  }
  std::vector<std::string> lanes;
  for (const Lane& lane : gdop.lanes) lanes.push_back(results.runs[lane.run].fidelity);
  gdop.notes.push_back(lanes.empty() ? "No epoch is without a fix."
                                     : "Bars at the foot: epochs without a fix, a lane for " + listed(lanes) + ".");
  chart.panels.push_back(std::move(gdop));
  chart.panels.push_back(std::move(satellites));
  chart.panels.push_back(std::move(nlos));
  return section("satellites", title,
                 "The dilution of precision (GDOP) multiplies the error of a range into the error of a fix; it jumps "
                 "where buildings take satellites away.",
                 run_legend(results.runs, shown) + figure(draw(chart), caption) + missing);
}

}  // namespace canyon::report
