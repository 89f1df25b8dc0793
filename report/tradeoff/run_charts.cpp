#include "canyon/report/tradeoff/run_charts.h"

#include <algorithm>
#include <cmath>

#include "canyon/report/draw/chart.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/format.h"
#include "canyon/report/tradeoff/ladder_section.h"

namespace canyon::report {
namespace {

/// One of the errors of a run.
struct ErrorOf {
  const char* title;
  double TradeoffRun::*value;
};
constexpr ErrorOf kErrors[] = {{"Position error, RMS", &TradeoffRun::position_m},
                               {"Map error, RMS", &TradeoffRun::map_m},
                               {"Registration error, RMS", &TradeoffRun::registration_m}};

bool is_drawn(const TradeoffRun& run, const ErrorOf& error) {
  return run.cpu_s > 0.0 && run.*error.value > 0.0;
}

/// Whether none is both quicker and closer.
bool on_front(const TradeoffRun& run, const ErrorOf& error, const TradeoffSummary& t) {
  return std::none_of(t.runs.begin(), t.runs.end(), [&](const TradeoffRun& other) {
    return is_drawn(other, error) && other.cpu_s < run.cpu_s && other.*error.value < run.*error.value;
  });
}

std::size_t colour_of(const TradeoffRun& run, bool front, const TradeoffSummary& t) {
  if (run.fidelity == t.fidelity) return kInUse;
  return front ? kFront : kDominated;
}

Line front_line(const ErrorOf& error, const TradeoffSummary& t) {
  std::vector<const TradeoffRun*> front;
  for (const TradeoffRun& run : t.runs)
    if (is_drawn(run, error) && on_front(run, error, t)) front.push_back(&run);
  std::sort(front.begin(), front.end(), [](const auto* a, const auto* b) { return a->cpu_s < b->cpu_s; });
  Line line{.run = kFront, .name = "front"};
  line.style = Line::Style::kStep;
  for (const TradeoffRun* run : front) {
    line.x.push_back(run->cpu_s);
    line.y.push_back(run->*error.value);
  }
  return line;
}

Axis scale_of(double min, double max) {
  return max > 10.0 * min ? Axis::decades(min, max) : Axis::logarithmic(min, max);
}

Panel panel_of(const ErrorOf& error, const TradeoffSummary& t) {
  Panel panel{.title = error.title, .unit = "m"};
  panel.height_px = 170;
  for (const TradeoffRun& run : t.runs) {
    if (!is_drawn(run, error)) {
      panel.notes.push_back(run.fidelity + ": no such error");
      continue;
    }
    const std::size_t colour = colour_of(run, on_front(run, error, t), t);
    const double y = run.*error.value;
    panel.lines.push_back(
        {.run = colour, .name = run.fidelity, .x = {run.cpu_s}, .y = {y}, .style = Line::Style::kPoints});
    if (run.cpu_low_s > 0.0)
      panel.lines.push_back({.run = colour,
                             .name = run.fidelity + ", least and most",
                             .x = {run.cpu_low_s, run.cpu_high_s},
                             .y = {y, y},
                             .style = Line::Style::kThin});
    panel.labels.push_back({colour, run.cpu_s, y, run.fidelity});
  }
  const Extremes y = positive_extremes_of(panel.lines);
  if (!y.drawn) return panel;
  panel.y = scale_of(0.8 * y.min, 1.25 * y.max);
  panel.lines.push_back(front_line(error, t));
  return panel;
}

}  // namespace

std::string run_error_charts(const TradeoffSummary& t) {
  Chart chart{.id = "runs-errors",
              .x = Axis::decades(1.0, 10.0),
              .x_label = "CPU time, s per simulated second",
              .solid = true,
              .title = "Work and precision of whole missions",
              .description = std::to_string(t.runs.size()) + " fidelities: errors over CPU time, both logarithmic.",
              .panels = {},
              .marks = {}};
  double low = INFINITY, high = 0.0;
  for (const ErrorOf& error : kErrors) {
    Panel panel = panel_of(error, t);
    if (!positive_extremes_of(panel.lines).drawn) continue;
    for (const Line& line : panel.lines) {
      for (const double x : line.x) {
        low = std::min(low, x);
        high = std::max(high, x);
      }
    }
    chart.panels.push_back(std::move(panel));
  }
  if (chart.panels.empty()) return "";
  chart.x = scale_of(0.9 * low, 1.1 * high);
  return figure(draw(chart), "Whole missions in an open loop: the same true motion and draws for all.");
}

std::string run_outcome_chart(const TradeoffSummary& t) {
  Panel panel{.title = "Missions that succeed", .unit = "%", .y = Axis::linear(-5.0, 105.0)};
  panel.height_px = 170;
  double low = INFINITY, high = 0.0;
  for (const TradeoffRun& run : t.runs) {
    if (!run.driven || !(run.mission_cpu_s > 0.0) || !(run.seeds > 0.0)) continue;
    const std::size_t colour = run.fidelity == t.fidelity ? kInUse : kFront;
    const double x = run.mission_cpu_s, share = 100.0 * run.success / run.seeds;
    panel.lines.push_back({.run = colour, .name = run.fidelity, .x = {x}, .y = {share}, .style = Line::Style::kPoints});
    panel.lines.push_back({.run = colour,
                           .name = run.fidelity + ", 95 %",
                           .x = {x, x * 1.000001},
                           .y = {100.0 * run.success_low, 100.0 * run.success_high},
                           .style = Line::Style::kThin});
    panel.labels.push_back({colour, x, share, run.fidelity});
    low = std::min(low, x);
    high = std::max(high, x);
  }
  if (panel.lines.empty()) return "";
  Chart chart{.id = "runs-outcomes",
              .x = scale_of(0.9 * low, 1.1 * high),
              .x_label = "CPU time of a mission to its end, s",
              .solid = true,
              .title = "Outcomes of whole missions",
              .description = "Share of missions that succeed over their CPU time.",
              .panels = {},
              .marks = {}};
  chart.panels.push_back(std::move(panel));
  return figure(draw(chart), "Each drives by itself, over seeds; bars: Wilson\xE2\x80\x99s 95 % interval.");
}

}  // namespace canyon::report
