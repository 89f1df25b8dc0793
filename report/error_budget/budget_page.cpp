#include "canyon/report/error_budget/budget_page.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/page.h"
#include "canyon/report/error_budget/study_header.h"
#include "canyon/report/format.h"
#include "canyon/report/read/json_fields.h"

namespace canyon::report {
namespace {

struct BudgetFigureText {
  const char* key;  ///< of the figure's object; "": the map's own
  const char* title;
  const char* unit;
};
constexpr std::array<BudgetFigureText, 9> kBudgetFigures{{{"", "Map, distance to true surfaces", "m2"},
                                                          {"height", "Map, height over level ground", "m2"},
                                                          {"keyframe", "Keyframes, position", "m2"},
                                                          {"keyframe_east", "Keyframes, east", "m2"},
                                                          {"keyframe_north", "Keyframes, north", "m2"},
                                                          {"keyframe_up", "Keyframes, up", "m2"},
                                                          {"keyframe_roll", "Keyframes, about forward", "deg2"},
                                                          {"keyframe_pitch", "Keyframes, about left", "deg2"},
                                                          {"keyframe_yaw", "Keyframes, about up", "deg2"}}};

std::string unit_shown(const BudgetFigureText& text) {
  return text.unit[0] == 'm' ? "m\xC2\xB2" : "deg\xC2\xB2";
}

/// A bar from the left, as wide as the share of what is shared out; nothing for shares below zero.
std::string share_bar(double part) {
  const double width = 100.0 * std::clamp(std::isfinite(part) ? part : 0.0, 0.0, 1.0);
  return "<svg viewBox=\"0 0 100 8\" width=\"100\" height=\"8\" preserveAspectRatio=\"none\" "
         "aria-hidden=\"true\"><rect "
         "width=\"" +
         fixed(width, 2) + "\" height=\"8\" fill=\"currentColor\"/></svg>";
}

std::string share_rows(const JsonFields& figure, const BudgetFigureText& text) {
  const std::string unit = std::string("_") + text.unit;
  const double shared = figure.number("total" + unit) - figure.number("floor" + unit);
  std::string rows;
  for (const auto& [node, path] : figure.list("shares", true)) {
    const JsonFields s(node, figure.file(), path, figure.error());
    const double share = s.number("share" + unit), part = share / shared;
    const double low = s.number("low" + unit), high = s.number("high" + unit);
    rows += "<tr><th scope=\"row\">" + escape_html(s.required_text("source")) + "</th><td>" +
            escape_html(s.flag("acts") ? show_number(share) : "0") +
            (std::isfinite(low)
                 ? "<span class=\"def\">" + escape_html(show_number(low) + " to " + show_number(high)) + "</span>"
                 : "") +
            "</td><td>" + escape_html(s.flag("acts") ? show_share(part) : "not in this mission") + "</td><td>" +
            share_bar(part) + "</td><td>" + escape_html(show_number(s.number("order_sigma" + unit), 2)) +
            "</td></tr>\n";
  }
  return rows;
}

std::string figure_table(const JsonFields& budget, const BudgetFigureText& text) {
  const JsonFields figure = text.key[0] == '\0' ? budget : budget.object(text.key);
  const std::string unit = std::string("_") + text.unit, shown = unit_shown(text);
  return "<h3>" + escape_html(text.title) + "</h3>\n<p>" + escape_html(show_number(figure.number("total" + unit))) +
         " " + shown + " in all, of which " + escape_html(show_number(figure.number("floor" + unit))) + " " + shown +
         " are left without any of these sources.</p>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
         "aria-label=\"" +
         escape_html(text.title) +
         "\"><table class=\"figures\">\n<thead><tr><th scope=\"col\" class=\"text\">source</th><th scope=\"col\">" +
         shown +
         "</th><th scope=\"col\">of all shared out</th><th scope=\"col\"></th><th scope=\"col\">1-sigma by "
         "orders</th></tr></thead>\n<tbody>" +
         share_rows(figure, text) + "</tbody></table></div>\n";
}

std::string budget_section(const JsonFields& f, const char* hidden, const char* title, const char* intro) {
  const std::string key = std::string("hidden_") + hidden;
  if (!f.has(key)) return {};
  const JsonFields budget = f.object(key);
  std::string body;
  for (const BudgetFigureText& text : kBudgetFigures) body += figure_table(budget, text);
  return section(key, title, intro, body);
}

std::string sources_section(const JsonFields& f) {
  std::string rows;
  const JsonNode* sources = f.find("sources");
  if (sources != nullptr && sources->is_object())
    for (const auto& [source, doc] : sources->items())
      if (doc.is_string())
        rows += "<tr><th scope=\"row\">" + escape_html(source) + "</th><td class=\"text\">" +
                escape_html(doc.get<std::string>()) + "</td></tr>\n";
  return section(
      "sources", "The sources",
      "Runs are replayed on one true motion and with the same random draws, some sources taken away. A share "
      "is by how much its going lowers the mean square error, in the mean over orders of going.",
      "<table class=\"figures\"><tbody>" + rows + "</tbody></table>\n");
}

/// The source with the largest share of the map's mean square error, in words.
std::string budget_headline(const JsonFields& f) {
  const double total = f.required_number("total_m2"), floor = f.required_number("floor_m2");
  std::string largest;
  double most = -1e300;
  for (const auto& [node, path] : f.list("shares", true)) {
    const JsonFields s(node, f.file(), path, f.error());
    if (!(s.number("share_m2") > most)) continue;
    most = s.number("share_m2");
    largest = s.required_text("source");
  }
  return "Of " + show_number(total) + " m\xC2\xB2 of map error " + largest + " causes " +
         show_share(most / (total - floor)) + " of what the sources cause together";
}

}  // namespace

Result<std::string> budget_page(const std::string& summary_path) {
  CANYON_TRY(const std::string text, read_text_file(summary_path));
  CANYON_TRY(const JsonFile file, JsonFile::parse(text, summary_path));
  std::optional<Error> error;
  const JsonFields f(&file.root(), file, "", error);
  std::string out = study_header(f, "", escape_html(budget_headline(f)) + ".", "");
  out += budget_section(f, "healed", "Hidden signals healed",
                        "Without multipath a hidden satellite is measured as it was, its error taken away.");
  out += budget_section(f, "dropped", "Hidden signals dropped",
                        "Without multipath a hidden satellite is not measured: its geometry goes with its error.");
  out += sources_section(f);
  if (error) return *error;
  return whole_page("Canyon: error budget", 1, out);
}

}  // namespace canyon::report
