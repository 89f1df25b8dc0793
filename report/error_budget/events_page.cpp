#include "canyon/report/error_budget/events_page.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/report/draw/chart.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/page.h"
#include "canyon/report/error_budget/study_header.h"
#include "canyon/report/format.h"
#include "canyon/report/read/json_fields.h"

namespace canyon::report {
namespace {

struct FollowedSeries {
  const char* key;
  const char* title;
};
constexpr std::array<FollowedSeries, 4> kFollowedSeries{{{"keyframe_prior", "Keyframes, filter alone"},
                                                         {"keyframe_registered", "Keyframes, registered"},
                                                         {"map_prior", "Map, filter alone"},
                                                         {"map_registered", "Map, registered"}}};

/// "0.31 (0.1 to 0.5)".
std::string with_interval(const JsonFields& number, const std::string& unit) {
  const double low = number.number("low_" + unit), high = number.number("high_" + unit);
  return escape_html(show_number(number.number("value_" + unit))) +
         (std::isfinite(low) && std::isfinite(high)
              ? "<span class=\"def\">" + escape_html(show_number(low) + " to " + show_number(high)) + "</span>"
              : "");
}

std::string effect_rows(const JsonFields& kind, bool registered) {
  std::string rows;
  for (std::size_t s = 0; s < kFollowedSeries.size(); ++s) {
    if (!registered && s % 2 == 1) continue;
    const JsonFields of = kind.object(kFollowedSeries[s].key);
    rows += "<tr><th scope=\"row\">" + escape_html(kFollowedSeries[s].title) + "</th><td>" +
            with_interval(of.object("effect"), "m") + "</td><td>" + with_interval(of.object("around_placebos"), "m") +
            "</td><td>" + with_interval(of.object("placebo_less_placebo"), "m") + "</td><td>" +
            with_interval(of.object("regression").object("effect"), "m") + "</td><td>" +
            with_interval(of.object("delay"), "s") + "</td><td>" + with_interval(of.object("duration"), "s") +
            "</td></tr>\n";
  }
  return rows;
}

std::string effect_table(const JsonFields& kind, bool registered) {
  return "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Effects\"><table class=\"figures\">\n"
         "<thead><tr><th scope=\"col\" class=\"text\">change, m</th><th scope=\"col\">event − placebos</th>"
         "<th scope=\"col\">placebos</th><th scope=\"col\">placebo − others</th>"
         "<th scope=\"col\">by regression</th><th scope=\"col\">delay, s</th><th scope=\"col\">duration, "
         "s</th></tr></thead>\n<tbody>" +
         effect_rows(kind, registered) + "</tbody></table></div>\n";
}

/// A curve and its band, in the colour of `run`.
void add_curve(const JsonFields& curve, std::size_t run, const char* name, const std::vector<double>& lags,
               Panel& panel) {
  panel.lines.push_back({run, name, lags, curve.numbers("mean_m", lags.size())});
  Band band{run, {}, {}, {}};
  const auto low = curve.numbers("low_m", lags.size()), high = curve.numbers("high_m", lags.size());
  for (std::size_t i = 0; i < std::min({lags.size(), low.size(), high.size()}); ++i) {
    if (!std::isfinite(low[i]) || !std::isfinite(high[i])) continue;
    band.x.push_back(lags[i]);
    band.low.push_back(low[i]);
    band.high.push_back(high[i]);
  }
  if (!band.x.empty()) panel.bands.push_back(std::move(band));
}

Axis axis_over(const Panel& panel) {
  double low = 0.0, high = 0.0;
  for (const Line& line : panel.lines)
    for (const double y : line.y)
      if (std::isfinite(y)) {
        low = std::min(low, y);
        high = std::max(high, y);
      }
  for (const Band& band : panel.bands)
    for (std::size_t i = 0; i < band.x.size(); ++i) {
      low = std::min(low, band.low[i]);
      high = std::max(high, band.high[i]);
    }
  return Axis::linear_rounded(low, high);
}

std::string lag_chart(const JsonFields& kind, const std::string& name, const std::vector<double>& lags,
                      bool registered) {
  Chart chart{.id = "events-" + name,
              .x = Axis::linear(lags.front(), lags.back()),
              .x_label = "time since the event, s",
              .title = "Errors around " + name,
              .description = "Change of four errors around the event and around its placebos",
              .panels = {},
              .marks = {}};
  std::replace(chart.id.begin(), chart.id.end(), '_', '-');
  for (std::size_t s = 0; s < kFollowedSeries.size(); ++s) {
    if (!registered && s % 2 == 1) continue;
    const JsonFields curves = kind.object(kFollowedSeries[s].key).object("curves");
    Panel panel{.title = kFollowedSeries[s].title, .unit = "m", .zero_line = true};
    add_curve(curves.object("event"), 0, "event", lags, panel);
    add_curve(curves.object("placebo"), 1, "placebo", lags, panel);
    panel.y = axis_over(panel);
    chart.panels.push_back(std::move(panel));
  }
  return draw(chart);
}

std::string kind_section(const JsonFields& kind, const std::string& name, const std::vector<double>& lags,
                         bool registered) {
  const JsonFields first = kind.object(kFollowedSeries[0].key);
  std::string body = "<p>" + escape_html(count_of(first.number("events"), "event", "events")) + ", " +
                     escape_html(show_count(first.number("matched"))) + " of them with placebos, mean size " +
                     escape_html(show_number(first.number("mean_size"))) + ".</p>\n";
  if (first.number("matched") > 0.0)
    body += effect_table(kind, registered) +
            figure(lag_chart(kind, name, lags, registered),
                   "First colour: around the events; second: around the same places without. Bands: seeds drawn anew.");
  else
    body += note("No event has a placebo.");
  return section(name, name, escape_html(kind.text("doc")), body);
}

}  // namespace

Result<std::string> events_page(const std::string& summary_path) {
  CANYON_TRY(const std::string text, read_text_file(summary_path));
  CANYON_TRY(const JsonFile file, JsonFile::parse(text, summary_path));
  std::optional<Error> error;
  const JsonFields f(&file.root(), file, "", error);
  const std::vector<double> lags = f.numbers("lag_s", f.list("lag_s", true).size());
  std::string out = study_header(
      f, " \xC2\xB7 " + count_of(f.number("starts"), "time of day", "times of day"),
      "What events do to map and keyframes.",
      "<p>Changes over " + escape_html(show_number(f.number("effect_s"))) +
          " s after the event, from the mean of the " + escape_html(show_number(f.number("before_s"))) +
          " s before it. A placebo is the same place on the same way at another time of day, without such an "
          "event.</p>\n");
  const JsonNode* kinds = f.find("kinds");
  if (kinds != nullptr && kinds->is_object() && lags.size() > 1)
    for (const auto& [name, node] : kinds->items())
      out += kind_section(JsonFields(&node, file, "kinds." + name, error), name, lags, f.flag("registered"));
  if (error) return *error;
  return whole_page("Canyon: error events", 2, out);
}

}  // namespace canyon::report
