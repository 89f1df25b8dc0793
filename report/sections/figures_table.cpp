#include <cmath>

#include "canyon/core/messages.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/format.h"
#include "canyon/report/read/run_story.h"
#include "canyon/report/sections/figures.h"
#include "canyon/report/sections/sections.h"

namespace canyon::report {
namespace {

/// The columns: the compared pair, its ratio, then the other pure runs.
class FiguresTable {
 public:
  explicit FiguresTable(const Results& results) : results_(results), runs_(pure_runs(results)) {
    if (runs_.empty()) runs_.push_back(0);
  }

  std::string write() const {
    std::string out =
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Table of all figures\"><table "
        "class=\"figures\">\n<thead>" +
        head() + "</thead>\n";
    if (!results_.open_loop) out += "<tbody><tr><th scope=\"row\">outcome</th>" + outcomes() + "</tr></tbody>\n";
    const std::string* group = nullptr;
    for (const Figure* figure : shown_figures(results_)) {
      if (group == nullptr || figure->group != *group) {
        if (group != nullptr) out += "</tbody>\n";
        group = &figure->group;
        out += "<tbody><tr class=\"group\"><th scope=\"rowgroup\" colspan=\"" + std::to_string(columns() + 3) + "\">" +
               escape_html(*group) + "</th></tr>\n";
      }
      out += line(*figure);
    }
    return out + (group != nullptr ? "</tbody>" : "") + "</table></div>\n";
  }

 private:
  bool has_ratio() const { return runs_.size() >= 2; }
  std::size_t columns() const { return runs_.size() + (has_ratio() ? 1 : 0); }
  const Run& run(std::size_t k) const { return results_.runs[runs_[k]]; }

  /// Writes one cell per column: `of_run(k)` for runs, `ratio` after the second.
  template <class OfRun>
  std::string cells(OfRun of_run, const std::string& ratio) const {
    std::string out;
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      out += of_run(k);
      if (k == 1) out += ratio;
    }
    return out;
  }

  std::string head() const {
    const std::string ratio = has_ratio() ? "<th scope=\"col\">" + escape_html(run(1).fidelity) +
                                                "\xE2\x80\x89/\xE2\x80\x89" + escape_html(run(0).fidelity) + "</th>"
                                          : "";
    return "<tr><td></td>" +
           cells([&](std::size_t k) { return "<th scope=\"col\">" + run_tag(results_.runs, runs_[k]) + "</th>"; },
                 ratio) +
           "<th scope=\"col\">unit</th><th scope=\"col\">better</th></tr>";
  }

  std::string outcomes() const {
    return cells(
               [&](std::size_t k) {
                 return std::string("<td class=\"outcome ") + outcome_class(run(k).outcome) + "\">" +
                        outcome_mark(run(k).outcome) + " " + escape_html(outcome_label(run(k).outcome)) + "</td>";
               },
               has_ratio() ? "<td></td>" : "") +
           "<td></td><td></td>";
  }

  /// The value, what it is a part of, and its interval.
  std::string value_cell(const Figure& figure, const Run& run) const {
    const double value = run.figure(figure.key), total = run.figure(figure.total);
    std::string text = show_figure(figure, value) + (std::isfinite(total) ? " of " + show_count(total) : "");
    if (const auto found = run.intervals.find(figure.key); found != run.intervals.end())
      text += "<span class=\"def\">" + show_interval(figure, found->second) + "</span>";
    return figure_cell(text, !std::isfinite(value));
  }

  std::string line(const Figure& row) const {
    std::string label = escape_html(row.label);
    if (const std::string meaning = figure_meaning(row, results_); !meaning.empty())
      label += "<span class=\"def\">" + escape_html(meaning) + "</span>";
    std::string ratio;
    if (has_ratio()) {
      const double first = run(0).figure(row.key), second = run(1).figure(row.key);
      const double value = at_cap(row, first) || at_cap(row, second) ? kNaN : second / first;
      const bool strong = value >= 2 || value <= 0.5;
      ratio = std::isfinite(value)
                  ? std::string("<td class=\"ratio") + (strong ? " strong" : "") + "\">" + show_number(value) + "</td>"
                  : figure_cell({}, true);
    }
    return "<tr><th scope=\"row\">" + label + "</th>" +
           cells([&](std::size_t k) { return value_cell(row, run(k)); }, ratio) + unit_cell(row) + "</tr>\n";
  }

  const Results& results_;
  std::vector<std::size_t> runs_;
};

/// What the vehicle did at each mission waypoint, for all runs.
std::string mission_waypoints(const Results& results) {
  std::string bodies;
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const std::vector<MissionWaypoint>& waypoints = results.runs[i].mission_waypoints;
    if (waypoints.empty()) continue;
    bodies += "<tbody>";
    for (std::size_t k = 0; k < waypoints.size(); ++k) {
      const MissionWaypoint& w = waypoints[k];
      bodies += "<tr>";
      if (k == 0) {
        bodies += "<th scope=\"rowgroup\" rowspan=\"" + std::to_string(waypoints.size()) + "\">" +
                  run_tag(results.runs, i) + "</th>";
      }
      bodies += "<td class=\"text\">" + escape_html(w.name) + "</td><td class=\"outcome " +
                (w.reached ? "good\">\xE2\x9C\x93 yes" : "bad\">\xE2\x9C\x95 no") + "</td>" +
                figure_cell(show_quantity(w.closest_m, "m"), !std::isfinite(w.closest_m)) +
                figure_cell(show_quantity(w.stopped_s, "s"), !std::isfinite(w.stopped_s)) +
                figure_cell(show_share(w.facade_seen_share), !std::isfinite(w.facade_seen_share)) + "</tr>\n";
    }
    bodies += "</tbody>\n";
  }
  if (bodies.empty()) return note("The results say nothing about single mission waypoints.");
  return "<h3>At the mission waypoints</h3>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Mission "
         "waypoints\"><table class=\"grouped\">\n<thead><tr><th scope=\"col\" class=\"text\">run</th><th scope=\"col\" "
         "class=\"text\">waypoint</th><th scope=\"col\" class=\"text\">reached</th><th scope=\"col\">closest</th><th "
         "scope=\"col\">stopped</th><th scope=\"col\">fa\xC3\xA7"
         "ade seen</th></tr></thead>\n" +
         bodies + "</table></div>\n";
}

}  // namespace

std::string figures_section(const Results& results) {
  const bool mixed = pure_runs(results).size() < results.runs.size();
  return section(
      "figures", "All figures",
      std::string("Errors are estimate minus truth. A dash is an undefined value; beneath a value stands its "
                  "95 % interval, where it has one. Ratios of two and more, or one half and less, are bold.") +
          (mixed ? " The mixed runs are in <a href=\"#two-by-two\">GNSS or IMU?</a>" : ""),
      FiguresTable(results).write() + mission_waypoints(results));
}

}  // namespace canyon::report
