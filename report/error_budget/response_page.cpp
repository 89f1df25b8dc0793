#include "canyon/report/error_budget/response_page.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/messages.h"
#include "canyon/report/draw/chart.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/page.h"
#include "canyon/report/error_budget/study_header.h"
#include "canyon/report/format.h"
#include "canyon/report/read/json_fields.h"

namespace canyon::report {
namespace {

/// One series of one curve of the summary.
struct HealedCurve {
  std::string method, kind, axis, half;
  double from_m = kNaN;  ///< all places: NaN
  std::vector<double> size, healed, low, high;
};

/// A size, or "below" or "beyond" those that were tried.
std::string half_shown(const JsonFields& series, const char* key) {
  const JsonNode* node = series.find(key);
  if (node != nullptr && node->is_string()) return "beyond";
  const double size = series.number(key);
  return size == 0.0 ? "below" : show_number(size);
}

HealedCurve read_curve(const JsonFields& f, const char* series_key) {
  HealedCurve out{.method = f.required_text("method"),
                  .kind = f.required_text("kind"),
                  .axis = f.text("axis"),
                  .half = {},
                  .from_m = f.number("from_m"),
                  .size = {},
                  .healed = {},
                  .low = {},
                  .high = {}};
  const JsonFields series = f.object(series_key);
  out.half = half_shown(series, "half_healed_up_to");
  const JsonNode* low = series.find("low");
  if (low != nullptr && !low->is_null())
    out.half += " (" + half_shown(series, "low") + " to " + half_shown(series, "high") + ")";
  for (const auto& [node, path] : series.list("points", true)) {
    const JsonFields point(node, f.file(), path, f.error());
    out.size.push_back(point.required_number("size"));
    out.healed.push_back(point.number("healed"));
    out.low.push_back(point.number("low"));
    out.high.push_back(point.number("high"));
  }
  return out;
}

/// Everywhere, by method: the healed share against the size. Shares below -1 are drawn as that.
std::string healed_chart(const std::string& id, const std::vector<HealedCurve>& curves,
                         const std::map<std::string, std::size_t>& colours) {
  Chart chart{.id = id,
              .x = Axis::logarithmic(curves.front().size.front(), curves.front().size.back()),
              .x_label = "size, in the unit of " + curves.front().kind,
              .title = "Healed share by size",
              .description = "1 - registered / prior by the size of the error, for each method",
              .panels = {},
              .marks = {}};
  Panel panel{.title = "Healed share of keyframes", .y = Axis::linear(-1.0, 1.0), .zero_line = true, .limit = 0.5};
  for (const HealedCurve& curve : curves) {
    Line line{colours.at(curve.method), curve.method, curve.size, curve.healed};
    for (double& y : line.y) y = std::max(y, -1.0);
    panel.lines.push_back(std::move(line));
  }
  chart.panels.push_back(std::move(panel));
  return draw(chart);
}

std::string healed_table(const std::vector<HealedCurve>& curves) {
  std::string head = "<th scope=\"col\" class=\"text\">method</th>", rows;
  for (const double size : curves.front().size) head += "<th scope=\"col\">" + escape_html(show_number(size)) + "</th>";
  for (const HealedCurve& curve : curves) {
    rows += "<tr><th scope=\"row\">" + escape_html(curve.method) + "</th>";
    for (std::size_t i = 0; i < curve.size.size(); ++i)
      rows += "<td>" + escape_html(show_number(curve.healed[i], 2)) +
              (std::isfinite(curve.low[i])
                   ? "<span class=\"def\">" +
                         escape_html(show_number(curve.low[i], 2) + " to " + show_number(curve.high[i], 2)) + "</span>"
                   : "") +
              "</td>";
    rows += "<td>" + escape_html(curve.half) + "</td></tr>\n";
  }
  return "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Healed shares\"><table class=\"figures\">\n"
         "<thead><tr>" +
         head + "<th scope=\"col\">half up to</th></tr></thead>\n<tbody>" + rows + "</tbody></table></div>\n";
}

std::string place_table(const std::vector<HealedCurve>& places) {
  if (places.empty()) return {};
  std::string rows;
  for (const HealedCurve& curve : places)
    rows += "<tr><th scope=\"row\">" + escape_html(curve.method) + "</th><td>" +
            escape_html(show_number(curve.from_m)) + "</td><td>" + escape_html(curve.half) + "</td></tr>\n";
  return "<details><summary>By place</summary><table class=\"figures\">\n<thead><tr><th scope=\"col\" "
         "class=\"text\">method</th><th scope=\"col\">from, m along the route</th><th scope=\"col\">half up "
         "to</th></tr></thead>\n<tbody>" +
         rows + "</tbody></table></details>\n";
}

/// One kind of error along one axis.
std::string sweep_section(const std::vector<HealedCurve>& curves, const std::string& doc,
                          const std::map<std::string, std::size_t>& colours) {
  std::vector<HealedCurve> everywhere, places;
  for (const HealedCurve& curve : curves) {
    if (std::isnan(curve.from_m))
      everywhere.push_back(curve);
    else if (curve.method != "none")
      places.push_back(curve);
  }
  if (everywhere.empty() || everywhere.front().size.empty()) return {};
  const HealedCurve& first = everywhere.front();
  std::string id = first.kind + (first.axis.empty() ? "" : "-" + first.axis);
  std::replace(id.begin(), id.end(), '_', '-');
  const std::string title = first.kind + (first.axis.empty() ? "" : ", " + first.axis);
  return section(id, title, "The estimate is " + escape_html(doc) + ".",
                 healed_table(everywhere) +
                     figure(healed_chart("chart-" + id, everywhere, colours),
                            "Level line: half healed. Below 0 registration makes it worse.") +
                     place_table(places));
}

}  // namespace

Result<std::string> response_page(const std::string& summary_path) {
  CANYON_TRY(const std::string text, read_text_file(summary_path));
  CANYON_TRY(const JsonFile file, JsonFile::parse(text, summary_path));
  std::optional<Error> error;
  const JsonFields f(&file.root(), file, "", error);
  std::string out =
      study_header(f, "", "Where registration stops healing.",
                   "<p>Recorded keyframes are mapped again with the true pose and an error laid on it. Healed: 1 "
                   "\xE2\x88\x92 registered / prior, of the root mean square errors of keyframes.</p>\n");
  std::map<std::string, std::size_t> colours;
  std::vector<std::string> order;
  std::map<std::string, std::vector<HealedCurve>> by_sweep;
  for (const auto& [node, path] : f.list("curves", true)) {
    HealedCurve curve = read_curve(JsonFields(node, file, path, error), "keyframe");
    colours.emplace(curve.method, colours.size());
    const std::string sweep = curve.kind + "/" + curve.axis;
    if (!by_sweep.contains(sweep)) order.push_back(sweep);
    by_sweep[sweep].push_back(std::move(curve));
  }
  for (const std::string& sweep : order)
    out += sweep_section(by_sweep[sweep], f.object("kinds").text(by_sweep[sweep].front().kind), colours);
  if (error) return *error;
  return whole_page("Canyon: error response", std::max<std::size_t>(1, colours.size()), out);
}

}  // namespace canyon::report
