#include <cmath>

#include "canyon/report/draw/chart.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/draw/time_charts.h"
#include "canyon/report/format.h"
#include "canyon/report/read/run_story.h"
#include "canyon/report/sections/sections.h"

namespace canyon::report {
namespace {

const double* cell_of(const TwoByTwo& table, std::string_view key, std::size_t row, std::size_t column) {
  const auto found = table.figures.find(key);
  return found == table.figures.end() || found->second.size() <= row ? nullptr : &found->second[row][column];
}

/// The run behind a cell, for its name and colour.
std::optional<std::size_t> run_of(const Results& results, const TwoByTwo& table, const std::string& gnss,
                                  const std::string& imu) {
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const Run& run = results.runs[i];
    if (run.filter == table.filter && run.gnss == gnss && run.imu == imu) return i;
  }
  return std::nullopt;
}

std::string cell(const Results& results, const TwoByTwo& table, std::size_t row, std::size_t column) {
  std::string out = "<td>";
  if (const auto i = run_of(results, table, table.gnss[row], table.imu[column]))
    out += "<p>" + run_tag(results.runs, *i) + "</p>";
  if (const double* successes = cell_of(table, "successes", row, column); successes && results.over_seeds) {
    const double* ended = cell_of(table, "ended", row, column);
    const double n = ended != nullptr ? *ended : results.over_seeds->count;
    if (std::isfinite(*successes))
      out += "<p class=\"outcome\">" +
             (n > 0 ? show_count(*successes) + " of " + show_count(n) + " seeds succeed" : "all seeds stopped") +
             "</p>";
  } else if (!results.open_loop && row < table.outcome.size()) {
    const std::string& outcome = table.outcome[row][column];
    out += outcome.empty() ? "<p class=\"undefined\">no outcome</p>"
                           : std::string("<p class=\"outcome ") + outcome_class(outcome) + "\">" +
                                 outcome_mark(outcome) + " " + escape_html(outcome_label(outcome)) + "</p>";
  }
  out += "<dl>";
  for (const Figure& figure : results.figures) {
    if (const double* value = cell_of(table, figure.key, row, column))
      out += "<div><dt>" + escape_html(figure.label) + "</dt><dd>" + show_quantity(*value, figure.unit) + "</dd></div>";
  }
  return out + "</dl></td>";
}

/// Which of the two sensors alone brings the more of the position error, if the four cells say so.
std::string attribution(const TwoByTwo& table) {
  if (table.gnss.size() != 2 || table.imu.size() != 2) return {};
  const auto at = [&](std::size_t r, std::size_t c) {
    const double* v = cell_of(table, "position_error_rms_m", r, c);
    return v ? *v : std::nan("");
  };
  const double base = at(0, 0), gnss = at(1, 0), imu = at(0, 1), both = at(1, 1);
  if (!std::isfinite(base + gnss + imu + both)) return {};
  return "Changing the GNSS alone from " + table.gnss[0] + " to " + table.gnss[1] + " takes the position error from " +
         show_quantity(base, "m") + " to " + show_quantity(gnss, "m") + ", changing the IMU alone to " +
         show_quantity(imu, "m") + ", both to " + show_quantity(both, "m") + ".";
}

/// Position error of the runs of the table against time.
std::string error_chart(const Results& results, const TwoByTwo& table) {
  Chart chart = time_chart(results, "two-by-two-chart" + (table.filter.empty() ? "" : "-" + table.filter),
                           "Position error of the runs of the table");
  chart.marks.clear();
  Panel panel{.title = "Position error, 3-D (logarithmic)", .unit = "m"};
  panel.height_px = 190;
  std::vector<std::size_t> drawn;
  for (const std::string& gnss : table.gnss) {
    for (const std::string& imu : table.imu) {
      const auto i = run_of(results, table, gnss, imu);
      if (!i || !results.runs[*i].nav || results.runs[*i].nav->rows == 0) continue;
      const EpochTable& nav = *results.runs[*i].nav;
      Line line{.run = *i, .name = results.runs[*i].fidelity, .x = nav["t_s"]};
      for (std::size_t k = 0; k < nav.rows; ++k) line.y.push_back(error_norm_m(nav, k));
      const Extremes e = extremes_of({line});
      if (e.drawn) chart.description += line.name + ": up to " + show_quantity(e.max, "m") + ". ";
      panel.lines.push_back(std::move(line));
      drawn.push_back(*i);
    }
  }
  if (!positive_extremes_of(panel.lines).drawn) return note("The results hold no navigation epochs of these runs.");
  panel.y = error_axis(panel.lines);
  chart.panels.push_back(std::move(panel));
  return run_legend(results.runs, drawn) + figure(draw(chart), {});
}

/// One table of GNSS by IMU, with the run errors below it.
std::string square(const Results& results, const TwoByTwo& table) {
  const std::string with = table.filter.empty() ? "" : " with filter " + table.filter;
  std::string body = "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"GNSS by IMU" +
                     escape_html(with) + "\"><table class=\"two-by-two\">\n<thead><tr><td></td>";
  for (const std::string& imu : table.imu) body += "<th scope=\"col\">IMU " + escape_html(imu) + "</th>";
  body += "</tr></thead>\n<tbody>";
  for (std::size_t r = 0; r < table.gnss.size(); ++r) {
    body += "<tr><th scope=\"row\">GNSS " + escape_html(table.gnss[r]) + "</th>";
    for (std::size_t c = 0; c < table.imu.size(); ++c) body += cell(results, table, r, c);
    body += "</tr>\n";
  }
  body += "</tbody></table></div>\n";
  return body + error_chart(results, table);
}

}  // namespace

std::string two_by_two_section(const Results& results) {
  if (results.runs.size() < 2) return {};
  const bool filters = results.two_by_two.size() > 1;
  const std::string title = filters ? "GNSS, IMU or filter?" : "GNSS or IMU?";
  if (results.two_by_two.empty()) {
    return section(
        "two-by-two", title, {},
        note("What the GNSS does and what the IMU, one drive of each cannot tell: each goes where its own errors "
             "lead it. compare --seeds 20 also drives with the GNSS of one fidelity and the IMU of the "
             "other, and compare --open-loop lays all four on one true motion."));
  }
  std::string says, body;
  for (const TwoByTwo& table : results.two_by_two) {
    const std::string told = attribution(table);
    if (filters && !told.empty()) says += "With filter " + table.filter + ": ";
    says += told + " ";
    if (filters) body += "<h3>Filter " + escape_html(table.filter) + "</h3>\n";
    body += square(results, table);
  }
  says +=
      results.open_loop ? (filters ? "All runs are on one true motion." : "All four runs are on one true motion.")
      : results.over_seeds
          ? "Medians over " + show_count(results.over_seeds->count) + " seeds; the chart shows the first."
          : std::string("Each run drove by itself: these are ") + (filters ? "separate" : "four") +
                " drives, and part of the difference may be where each of them went (compare --open-loop takes that "
                "away).";
  says += " Everything but the IMU and the first attitude goes with the GNSS, so the LIDAR does.";
  return section("two-by-two", title, escape_html(says), body);
}

}  // namespace canyon::report
