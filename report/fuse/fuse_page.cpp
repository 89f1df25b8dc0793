#include "canyon/report/fuse/fuse_page.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/process/progress.h"
#include "canyon/report/draw/chart.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/page.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"
#include "canyon/report/fuse/fused_run.h"
#include "canyon/report/sections/figures.h"
#include "canyon/report/sections/filter_verdict.h"

namespace canyon::report {
namespace {

bool has_errors(const FusedRun& run) {
  return run.errors.front().has_value() && run.errors.front()->rows > 0;
}

std::string tag(const FusedRun& run, std::size_t i) {
  return "<span class=\"tag keep " + run_class(i) +
         "\"><svg class=\"swatch\" viewBox=\"0 0 22 8\" aria-hidden=\"true\"><path d=\"M1 4H21\"/></svg>" +
         escape_html(run.trajectories[i].name) + "</span>";
}

std::string headline(const FusedRun& run) {
  const std::string length = show_quantity(run.duration_s, "s");
  if (!has_errors(run)) return length + " of recorded data; there is no reference to compare the estimate with.";
  const FusedFigures& filter = run.trajectories.front();
  std::string out =
      "The filter\xE2\x80\x99s estimate is " + show_quantity(filter.rms_3d_m, "m") + " off (3-D RMS) over " + length;
  if (const auto outages = static_cast<double>(run.outages.front().size()); outages > 0.0)
    out += " with " + count_of(outages, "outage", "outages") + " of the fixes";
  if (run.trajectories.size() > 1)
    out += "; smoothed by " + run.trajectories[1].name + " it is " + show_quantity(run.trajectories[1].rms_3d_m, "m");
  return out + ".";
}

std::string fused_verdict_section(const FusedRun& run) {
  std::string facts = show_count(run.samples) + " IMU samples; " + show_count(run.fixes_accepted) + " of " +
                      count_of(run.fixes, "fix", "fixes") + " accepted";
  if (run.fixes_withheld > 0.0) facts += ", " + show_count(run.fixes_withheld) + " withheld";
  facts += "; start: " + run.start_from;
  if (run.restarts > 0.0) facts += "; " + count_of(run.restarts, "new start", "new starts") + " after long gaps";
  std::string body = "<p class=\"intro\">What of the filter does not fit what was found, the worst first:</p>\n" +
                     filter_words(run.verdict) + "<p>" + escape_html(facts + ".") + "</p>\n";
  if (!run.mended.empty()) body += note("Mended, or left out, of what was recorded: " + listed(run.mended) + ".");
  return section("verdict", "Verdict", {}, body);
}

std::string three(const std::vector<double>& values, std::string_view unit) {
  if (values.size() != 3 || !std::isfinite(values[0])) return figure_cell({}, true);
  return figure_cell(show_number(values[0]) + ", " + show_number(values[1]) + ", " + show_quantity(values[2], unit),
                     false);
}

/// Root mean squares, a column for each trajectory.
std::string error_table(const FusedRun& run) {
  const auto line = [&](const char* title, const char* meaning, const auto& value) {
    std::string out = std::string("<tr><th scope=\"row\">") + title +
                      (*meaning != '\0' ? std::string("<span class=\"def\">") + meaning + "</span>" : "") + "</th>";
    for (const FusedFigures& of : run.trajectories) out += value(of);
    return out + "</tr>\n";
  };
  const auto number = [](double value, std::string_view unit) {
    return figure_cell(unit.empty() ? show_number(value) : show_quantity(value, unit), !std::isfinite(value));
  };
  std::string head;
  for (std::size_t i = 0; i < run.trajectories.size(); ++i) head += "<th scope=\"col\">" + tag(run, i) + "</th>";
  std::string rows =
      line("position, 3-D RMS", "", [&](const FusedFigures& f) { return number(f.rms_3d_m, "m"); }) +
      line("position, RMS", "east, north, up", [&](const FusedFigures& f) { return three(f.position_enu_m, "m"); }) +
      line("velocity, RMS", "east, north, up",
           [&](const FusedFigures& f) { return three(f.velocity_enu_m_s, "m/s"); }) +
      line("attitude, RMS", "roll, pitch, yaw",
           [&](const FusedFigures& f) { return three(f.attitude_deg, "\xC2\xB0"); }) +
      line("position at the end", "", [&](const FusedFigures& f) { return number(f.final_m, "m"); }) +
      line("NEES per state", "squared errors over the covariance claimed for them; 1 of an honest estimate",
           [&](const FusedFigures& f) { return number(f.nees, ""); });
  if (!run.outages.front().empty())
    rows +=
        line("outages, horizontal", "RMS over outages of the largest error in each",
             [&](const FusedFigures& f) { return number(f.outage_horizontal_m, "m"); }) +
        line("outages, vertical", "the same", [&](const FusedFigures& f) { return number(f.outage_vertical_m, "m"); });
  return "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Errors\"><table "
         "class=\"figures\">\n<thead><tr><td></td>" +
         head + "</tr></thead>\n<tbody>" + rows + "</tbody></table></div>\n";
}

struct Axes {
  const char *title, *unit, *error, *sigma;
};
constexpr std::array<Axes, 9> kAxes{{{"East error", "m", "error_e_m", "sigma_e_m"},
                                     {"North error", "m", "error_n_m", "sigma_n_m"},
                                     {"Up error", "m", "error_u_m", "sigma_u_m"},
                                     {"East velocity error", "m/s", "error_ve_m_s", "sigma_ve_m_s"},
                                     {"North velocity error", "m/s", "error_vn_m_s", "sigma_vn_m_s"},
                                     {"Up velocity error", "m/s", "error_vu_m_s", "sigma_vu_m_s"},
                                     {"Roll error", "\xC2\xB0", "error_roll_deg", "sigma_roll_deg"},
                                     {"Pitch error", "\xC2\xB0", "error_pitch_deg", "sigma_pitch_deg"},
                                     {"Yaw error", "\xC2\xB0", "error_yaw_deg", "sigma_yaw_deg"}}};

Lane outage_lane(const FusedRun& run) {
  Lane lane{.run = 0, .name = "fixes withheld"};
  for (const FusedOutage& outage : run.outages.front()) lane.intervals.emplace_back(outage.from_s, outage.to_s);
  return lane;
}

/// Empty where the reference says nothing of it.
std::optional<Panel> error_panel(const FusedRun& run, const Axes& axes) {
  Panel panel{.title = axes.title, .unit = axes.unit};
  panel.zero_line = true;
  panel.height_px = 130;
  double reach = 0.0;
  for (std::size_t i = 0; i < run.errors.size(); ++i) {
    if (!run.errors[i]) continue;
    const EpochTable& t = *run.errors[i];
    panel.lines.push_back({.run = i, .name = run.trajectories[i].name, .x = t["t_s"], .y = t[axes.error]});
    Band band{.run = i, .x = t["t_s"], .low = {}, .high = {}};
    for (const double sigma : t[axes.sigma]) {
      band.low.push_back(-sigma);
      band.high.push_back(sigma);
    }
    std::vector<double> sigmas = t[axes.sigma];
    if (!sigmas.empty()) {
      const auto most = sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() * 95 / 100);
      std::nth_element(sigmas.begin(), most, sigmas.end());
      if (std::isfinite(*most)) reach = std::max(reach, *most);
    }
    panel.bands.push_back(std::move(band));
  }
  const Extremes e = extremes_of(panel.lines);
  if (!e.drawn) return std::nullopt;
  reach = std::max({reach, std::abs(e.min), std::abs(e.max)});
  panel.y = Axis::linear_rounded(-reach, reach, 4);
  if (!run.outages.front().empty()) panel.lanes.push_back(outage_lane(run));
  return panel;
}

std::string errors_section(const FusedRun& run) {
  const char* const title = "Errors over time";
  if (!has_errors(run))
    return section("errors", title, {},
                   note("There was no reference (--truth): how far off the estimate is, is not known."));
  Chart chart;
  chart.id = "error-chart";
  chart.x_label = "time from start, s";
  chart.x = Axis::seconds(0, run.duration_s);
  chart.time = true;
  chart.title = title;
  chart.description = "3-D RMS " + show_quantity(run.trajectories.front().rms_3d_m, "m") + ".";
  for (const Axes& axes : kAxes)
    if (auto panel = error_panel(run, axes)) chart.panels.push_back(*std::move(panel));
  std::string legend = "<p class=\"legend\">";
  for (std::size_t i = 0; i < run.trajectories.size(); ++i) legend += tag(run, i) + " ";
  std::string caption =
      "Estimate minus reference. Bands: the \xC2\xB1"
      "1\xCF\x83 that is claimed; of an honest estimate "
      "68 % of the errors lie within. Where no band is seen it is thinner than the line.";
  if (!run.outages.front().empty()) caption += " Bars at the foot: fixes withheld (--outage).";
  return section("errors", title, {}, error_table(run) + legend + "</p>\n" + figure(draw(chart), caption));
}

std::string outages_section(const FusedRun& run) {
  if (run.outages.front().empty()) return {};
  std::string head, rows;
  for (std::size_t i = 0; i < run.trajectories.size(); ++i)
    head += "<th scope=\"col\">" + tag(run, i) + ", horizontal</th><th scope=\"col\">vertical</th>";
  for (std::size_t k = 0; k < run.outages.front().size(); ++k) {
    const FusedOutage& outage = run.outages.front()[k];
    rows += "<tr><th scope=\"row\">" + show_number(outage.from_s, 4) + " to " + show_quantity(outage.to_s, "s", 4) +
            "</th>";
    for (const std::vector<FusedOutage>& of : run.outages) {
      const FusedOutage* same = k < of.size() ? &of[k] : nullptr;
      for (const double most : {same != nullptr ? same->horizontal_max_m : std::nan(""),
                                same != nullptr ? same->vertical_max_m : std::nan("")})
        rows += figure_cell(show_quantity(most, "m"), !std::isfinite(most));
    }
    rows += "</tr>\n";
  }
  return section(
      "outages", "Outages of the fixes",
      "Fixes were withheld on purpose, to see how far the estimate drifts without them. The largest error in "
      "each outage, against the reference.",
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Outages\"><table "
      "class=\"figures\">\n<thead><tr><th scope=\"col\" class=\"text\">from start</th>" +
          head + "</tr></thead>\n<tbody>" + rows + "</tbody></table></div>\n");
}

Panel nis_panel(const FusedMeasurement& m) {
  constexpr double kFalseAlarm = 1e-3, kLowest = 0.01;
  const double limit = chi_square_threshold(kFalseAlarm, std::max(m.dimension, 1));
  Panel panel{.title = "NIS of \xE2\x80\x9C" + m.name + "\xE2\x80\x9D (logarithmic)"};
  panel.lines.push_back({.run = 0, .name = m.name, .x = m.t_s, .y = m.nis, .style = Line::Style::kThin});
  panel.y = Axis::logarithmic(kLowest, std::max(2.0 * limit, extremes_of(panel.lines).max));
  panel.limit = limit;
  panel.height_px = 110;
  panel.notes.push_back(count_of(m.count, "innovation", "innovations") + " of " + std::to_string(m.dimension) +
                        (m.dimension == 1 ? " dimension, " : " dimensions, ") + show_count(m.accepted) +
                        " accepted. Dashed: " + show_number(limit) +
                        ", which an honest filter exceeds once in a thousand.");
  return panel;
}

std::string innovations_section(const FusedRun& run) {
  const char* const title = "Innovations";
  if (run.innovations.empty()) return section("innovations", title, {}, note("Nothing was measured."));
  Chart chart;
  chart.id = "innovation-chart";
  chart.x_label = "time from start, s";
  chart.x = Axis::seconds(0, run.duration_s);
  chart.time = true;
  chart.title = title;
  for (const FusedMeasurement& m : run.innovations) {
    throw_if_cancelled();
    chart.panels.push_back(nis_panel(m));
    chart.description += m.name + ": " + count_of(m.count, "innovation", "innovations") + ". ";
  }
  return section(
      "innovations", title,
      "What was measured minus what the filter predicted, squared and divided by the variance that the filter "
      "expected of it (NIS). Of an honest filter its mean is the number of dimensions.",
      figure(draw(chart), {}));
}

std::string consistency_section(const FusedRun& run) {
  const std::string table = consistency_table(run.verdict), states = observability_table(run.verdict);
  if (table.empty() && states.empty()) return {};
  return section(
      "filter", "Does the filter know how wrong it is?",
      "How many times larger than claimed errors and innovations are, as roots of mean squares; bold where "
      "that is beyond what chance makes of an honest filter in one of a hundred runs, all lines together.",
      table + (states.empty() ? std::string()
                              : "<h3>What the measurements tell of each state</h3>\n<p class=\"intro\">The "
                                "1\xCF\x83 at the end of the run, over what it would be had nothing been "
                                "measured, and when that fell to a half. A state that never gets there is not "
                                "observed: its value is what was assumed.</p>\n<details><summary>All states"
                                "</summary>\n" +
                                    states + "</details>\n" + observability_chart(run.verdict, 0)));
}

std::string made_section(const FusedRun& run) {
  const auto fact = [](const char* name, const std::string& text) {
    return "<div><dt>" + std::string(name) + "</dt><dd>" + escape_html(text.empty() ? "\xE2\x80\x93" : text) +
           "</dd></div>\n";
  };
  return section("made", "What it was made of", {},
                 "<dl class=\"facts\">\n" + fact("IMU", run.imu) + fact("fixes", run.gnss) +
                     fact("reference", run.truth) + fact("start", run.start_from) +
                     fact("states beside attitude, position, velocity", listed(run.states)) +
                     fact("measurements", listed(run.measurements)) + "</dl>\n");
}

}  // namespace

Result<std::string> fuse_page(const std::string& directory) {
  CANYON_TRY(const FusedRun run, read_fused_run(directory));
  std::string out =
      "<header>\n<p class=\"kicker\">Canyon \xC2\xB7 the filter on recorded data</p>\n<h1>" +
      escape_html(headline(run)) +
      "</h1>\n<nav aria-label=\"Contents\"><a href=\"#verdict\">Verdict</a> <a href=\"#errors\">Errors</a> " +
      std::string(run.outages.front().empty() ? "" : "<a href=\"#outages\">Outages</a> ") +
      "<a href=\"#innovations\">Innovations</a> <a href=\"#filter\">Filter</a> <a href=\"#made\">What it was made "
      "of</a></nav>\n</header>\n";
  for (const auto part : {fused_verdict_section, errors_section, outages_section, innovations_section,
                          consistency_section, made_section}) {
    throw_if_cancelled();
    out += part(run);
  }
  return whole_page("Canyon: fused logs", 2, out);
}

}  // namespace canyon::report
