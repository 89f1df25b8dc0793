#include "canyon/report/drive_check/drive_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/process/progress.h"
#include "canyon/report/draw/chart.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/page.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"
#include "canyon/report/read/epoch_table.h"
#include "canyon/report/read/json_fields.h"
#include "canyon/report/sections/figures.h"

namespace canyon::report {
namespace {

constexpr std::array kSides{"simulated", "measured"};

std::string side_tag(std::size_t i) {
  return "<span class=\"tag keep " + run_class(i) +
         "\"><svg class=\"swatch\" viewBox=\"0 0 22 8\" aria-hidden=\"true\"><path d=\"M1 4H21\"/></svg>" + kSides[i] +
         "</span>";
}

std::string both_tags() {
  return "<p class=\"legend\">" + side_tag(0) + " " + side_tag(1) + "</p>\n";
}

/// A number, or several that belong together: "10 / 84"; undefined ones are dashes.
std::string shown(const JsonNode* node) {
  if (node == nullptr || node->is_null()) return "\xE2\x80\x93";
  if (node->is_number()) return show_number(node->get<double>());
  std::string out;
  if (node->is_array())
    for (const JsonNode& one : *node) out += (out.empty() ? "" : " / ") + shown(&one);
  return out;
}

/// "8 to 12" of a pair, or of each pair of a list.
std::string shown_interval(const JsonNode* node) {
  if (node == nullptr || !node->is_array() || node->empty()) return {};
  if (!node->front().is_array()) return node->size() == 2 ? shown(&(*node)[0]) + " to " + shown(&(*node)[1]) : "";
  std::string out;
  for (const JsonNode& pair : *node) out += (out.empty() ? "" : " / ") + shown_interval(&pair);
  return out;
}

std::string figure_rows(const JsonFields& f) {
  std::string rows;
  for (const auto& [node, path] : f.list("figures", true)) {
    const JsonFields row(node, f.file(), path, f.error());
    const std::string key = row.required_text("key");
    rows += "<tr><th scope=\"row\">" + escape_html(row.required_text("label")) + "</th>";
    for (const char* side : kSides) {
      const std::string spread = side == kSides[0] ? "simulated_draws" : "measured_interval";
      const std::string interval = shown_interval(f.object(spread).find(key));
      rows += "<td>" + escape_html(shown(f.object(side).find(key))) +
              (interval.empty() ? "" : "<span class=\"def\">" + escape_html(interval) + "</span>") + "</td>";
    }
    rows += "</tr>\n";
  }
  return rows;
}

std::string score_words(const JsonFields& f) {
  if (!f.has("score")) return {};
  const JsonFields s = f.object("score");
  return "<p>Range errors of single signals, foretold by " + count_of(s.number("draws"), "draw", "draws") +
         " of the simulation: CRPS " + show_quantity(s.number("crps_simulation_m"), "m") +
         "; by measured errors of other times " + show_quantity(s.number("crps_blind_m"), "m") +
         ", by those of satellites as high " + show_quantity(s.number("crps_elevation_m"), "m") +
         ". Simulation less these, 95 %: " + escape_html(shown_interval(s.find("against_blind_m"))) + " and " +
         escape_html(shown_interval(s.find("against_elevation_m"))) + " m.</p>\n";
}

std::string figures_section(const JsonFields& f) {
  const std::string table =
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Figures\"><table "
      "class=\"figures\">\n<thead><tr><th "
      "scope=\"col\" class=\"text\">figure</th><th scope=\"col\">" +
      side_tag(0) + "</th><th scope=\"col\">" + side_tag(1) + "</th></tr></thead>\n<tbody>" + figure_rows(f) +
      "</tbody></table></div>\n";
  return section(
      "figures", "Side by side",
      "Both receivers measured by the same rules at the same epochs. Beneath: 5 to 95 %, of the simulated over "
      "draws of what the map does not know, of the measured over resampled blocks of 20 s.",
      table + score_words(f));
}

struct Signals {
  EpochTable table;

  std::vector<double> of(std::size_t side, double in_sight, const char* column) const {
    std::vector<double> out;
    for (std::size_t i = 0; i < table.rows; ++i)
      if (table.text("side")[i] == kSides[side] && table["in_sight"][i] == in_sight && std::isfinite(table[column][i]))
        out.push_back(table[column][i]);
    std::sort(out.begin(), out.end());
    return out;
  }
};

/// Shares of what is less, at 200 places at most.
Line distribution(std::size_t side, const std::vector<double>& sorted) {
  Line line{.run = side, .name = kSides[side]};
  const std::size_t n = sorted.size(), step = std::max<std::size_t>(n / 200, 1);
  for (std::size_t i = 0; i < n; i += step) {
    line.x.push_back(sorted[i]);
    line.y.push_back((static_cast<double>(i) + 0.5) / static_cast<double>(n));
  }
  return line;
}

using BothSides = std::array<std::vector<double>, kSides.size()>;

std::string distribution_chart(const BothSides& sorted, const char* id, const char* title, const char* unit) {
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.x_label = std::string(title) + ", " + unit;
  Panel panel{.title = "share that is less"};
  panel.height_px = 150;
  double low = 1e300, high = -1e300;
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const std::vector<double>& values = sorted[side];
    if (values.empty()) continue;
    // A few outliers do not draw the rest together.
    low = std::min(low, values[values.size() / 200]);
    high = std::max(high, values[values.size() - 1 - values.size() / 200]);
    panel.lines.push_back(distribution(side, values));
    chart.description +=
        std::string(kSides[side]) + ": median " + show_quantity(values[values.size() / 2], unit) + ". ";
  }
  if (panel.lines.empty()) return note(std::string(title) + ": there is none.");
  chart.x = Axis::linear_rounded(low, std::max(high, low + 1e-3), 6);
  chart.panels.push_back(std::move(panel));
  return figure(draw(chart), escape_html(title));
}

/// Of a distribution that summary.json gives by its percentiles over all instants, null where there is no fix: those
/// are put at the farthest that is drawn, so that shares stay shares of all.
BothSides percentiles(const JsonFields& f, const char* key) {
  BothSides out;
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const JsonNode* const all = f.object("distributions").object(key).object(kSides[side]).find("percentiles");
    if (all == nullptr || !all->is_array()) continue;
    for (const JsonNode& one : *all)
      out[side].push_back(one.is_number() ? one.get<double>() : std::numeric_limits<double>::infinity());
  }
  double farthest = 0.0;
  for (const std::vector<double>& values : out)
    for (const double v : values)
      if (std::isfinite(v)) farthest = std::max(farthest, v);
  for (std::vector<double>& values : out)
    std::replace(values.begin(), values.end(), std::numeric_limits<double>::infinity(), farthest);
  return out;
}

std::string distributions_section(const JsonFields& f, const Signals& signals) {
  struct OfSignals {
    const char *id, *title, *unit, *column;
    double in_sight;
  };
  constexpr OfSignals kOfSignals[] = {
      {"cn0-in-sight", "C/N0 of satellites in sight", "dB-Hz", "cn0_dbhz", 1.0},
      {"cn0-hidden", "C/N0 of hidden satellites", "dB-Hz", "cn0_dbhz", 0.0},
      {"error-in-sight", "Range error of satellites in sight", "m", "error_m", 1.0},
      {"error-hidden", "Range error of hidden satellites", "m", "error_m", 0.0},
      {"rate-in-sight", "Range-rate error of satellites in sight", "m/s", "rate_error_m_s", 1.0},
      {"rate-hidden", "Range-rate error of hidden satellites", "m/s", "rate_error_m_s", 0.0},
  };
  std::string charts;
  for (const OfSignals& row : kOfSignals)
    charts += distribution_chart({signals.of(0, row.in_sight, row.column), signals.of(1, row.in_sight, row.column)},
                                 row.id, row.title, row.unit);
  charts += distribution_chart(percentiles(f, "fix_horizontal_error_m"), "fix-error", "Horizontal error of fixes", "m");
  return section("distributions", "Distributions", {}, both_tags() + charts);
}

std::string satellites_section(const Signals& signals) {
  const EpochTable& t = signals.table;
  if (t.rows == 0) return section("satellites", "Each satellite over time", {}, note("Nothing was tracked."));
  const double start_s = *std::min_element(t["sow"].begin(), t["sow"].end());
  const double end_s = *std::max_element(t["sow"].begin(), t["sow"].end());
  std::map<std::string, std::array<Line, 2>> lines;
  std::map<std::string, std::vector<double>> hidden_s;
  for (std::size_t i = 0; i < t.rows; ++i) {
    const std::size_t side = t.text("side")[i] == kSides[0] ? 0 : 1;
    Line& line = lines[t.text("satellite")[i]][side];
    line.run = side;
    line.name = kSides[side];
    line.style = Line::Style::kPoints;
    line.x.push_back(t["sow"][i] - start_s);
    line.y.push_back(t["error_m"][i]);
    if (t["in_sight"][i] == 0.0) hidden_s[t.text("satellite")[i]].push_back(t["sow"][i] - start_s);
  }
  Chart chart;
  chart.id = "satellite-chart";
  chart.title = "Range errors";
  chart.x_label = "time from start, s";
  chart.x = Axis::seconds(0, std::max(end_s - start_s, 1.0));
  chart.time = true;
  for (auto& [name, sides] : lines) {
    throw_if_cancelled();
    Panel panel{.title = name, .unit = "m"};
    panel.height_px = 90;
    panel.zero_line = true;
    for (Line& line : sides)
      if (!line.x.empty()) panel.lines.push_back(std::move(line));
    const Extremes e = extremes_of(panel.lines);
    if (!e.drawn) continue;
    panel.y = Axis::linear_rounded(std::min(e.min, 0.0), std::max(e.max, 1.0), 3);
    const double share = static_cast<double>(hidden_s[name].size());
    panel.notes.push_back(share > 0.0 ? count_of(share, "time", "times") + " tracked while hidden" : "always in sight");
    chart.panels.push_back(std::move(panel));
  }
  chart.description = count_of(static_cast<double>(chart.panels.size()), "satellite", "satellites") + ".";
  return section("satellites", "Each satellite over time",
                 "Range error against the free straight way, the receiver\xE2\x80\x99s clock taken out.",
                 both_tags() + figure(draw(chart), {}));
}

}  // namespace

Result<std::string> drive_page(const std::string& directory) {
  const std::string path = directory + "/summary.json", table = directory + "/signals.csv";
  CANYON_TRY(const std::string text, read_text_file(path));
  CANYON_TRY(const JsonFile file, JsonFile::parse(text, path));
  std::optional<Error> error;
  const JsonFields f(&file.root(), file, "", error);
  CANYON_TRY(const std::string csv, read_text_file(table));
  Signals signals;
  CANYON_TRY(signals.table,
             parse_epoch_table(csv, table,
                               {.numbers = {"gps_week", "sow", "in_sight", "cn0_dbhz", "error_m", "rate_error_m_s"},
                                .texts = {"side", "satellite"},
                                .in_order = false}));
  const std::string figures = figures_section(f);
  const double epochs = f.required_number("epochs");
  if (error) return *error;
  std::string out =
      "<header>\n<p class=\"kicker\">Canyon \xC2\xB7 a recorded drive and its simulation</p>\n<h1>Fixes of the "
      "simulated drive "
      "are " +
      escape_html(show_quantity(f.object("simulated").number("fix_h50_m"), "m")) +
      " off in the median, of the recorded " +
      escape_html(show_quantity(f.object("measured").number("fix_h50_m"), "m")) + ", over " +
      count_of(epochs, "epoch", "epochs") +
      ".</h1>\n<nav aria-label=\"Contents\"><a href=\"#figures\">Side by side</a> <a "
      "href=\"#distributions\">Distributions</a> <a href=\"#satellites\">Satellites</a></nav>\n</header>\n";
  out += figures + distributions_section(f, signals) + satellites_section(signals);
  return whole_page("Canyon: a recorded drive and its simulation", 2, out);
}

}  // namespace canyon::report
