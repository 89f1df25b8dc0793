#include "canyon/report/reproduce/reproduce_page.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/process/progress.h"
#include "canyon/report/draw/chart.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/page.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"
#include "canyon/report/reproduce/paper_summary.h"

namespace canyon::report {
namespace {

constexpr std::size_t kColours = 6;
// Of a drawing from above: to scale on a page so wide, and as high as it wants within these.
constexpr double kPage_px = 1000.0, kLeastHigh_px = 420.0, kMostHigh_px = 640.0;

/// "0.9 to 1.8, n = 20": empty of a single value.
std::string shown_spread(const PaperOurs& ours) {
  std::string out;
  if (std::isfinite(ours.low) && std::isfinite(ours.high))
    out = show_number(ours.low) + " to " + show_number(ours.high);
  if (ours.n > 1.0) out += (out.empty() ? "n = " : ", n = ") + show_count(ours.n);
  return out;
}

/// A row a form of ours; the paper's number stands in the first.
std::string number_rows(const PaperNumber& number) {
  std::string out;
  for (std::size_t i = 0; i < number.ours.size(); ++i) {
    const PaperOurs& ours = number.ours[i];
    const bool near = ours.form == number.nearest;
    const std::string value = show_number(ours.value);
    const auto once = [&](const std::string& html) { return i == 0 ? html : std::string(); };
    out += "<tr><th scope=\"row\">" + once(escape_html(number.what + (number.unit.empty() ? "" : ", " + number.unit))) +
           "</th><td>" + once(show_number(number.paper)) + "</td><td>" + once(show_number(number.real)) +
           "</td><td class=\"text\">" + escape_html(ours.form) + "</td><td>" + (near ? "<b>" + value + "</b>" : value) +
           "</td><td>" + shown_spread(ours) + "</td><td>" +
           (near ? "\xC3\x97 " + show_number(number.ratio) : std::string()) + "</td></tr>\n";
  }
  return out;
}

std::string number_table(const PaperSection& part) {
  if (part.rows.empty()) return "";
  std::string out =
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" + escape_html(part.title) +
      "\"><table>\n<thead><tr><th scope=\"col\" class=\"text\">what</th><th>paper</th><th>its real sensor</th><th "
      "class=\"text\">ours</th><th>value</th><th>range</th><th>of the paper's</th></tr></thead>\n<tbody>";
  for (const PaperNumber& number : part.rows) out += number_rows(number);
  return out + "</tbody></table></div>\n";
}

/// Both axes so that a metre is as long upright as across, on a page of the usual width.
void draw_to_scale(Chart& chart, Panel& panel, const Extremes& x, const Extremes& y) {
  const double wide_m = std::max(x.max - x.min, 1e-6), high_m = std::max(y.max - y.min, 1e-6);
  panel.height_px = static_cast<int>(std::clamp(kPage_px * high_m / wide_m, kLeastHigh_px, kMostHigh_px));
  const double high_px = panel.height_px;
  const double scale = std::max(wide_m / kPage_px, high_m / high_px) * 1.08;
  const double mx = 0.5 * (x.min + x.max), my = 0.5 * (y.min + y.max);
  chart.x = Axis::linear(mx - 0.5 * scale * kPage_px, mx + 0.5 * scale * kPage_px, 9);
  chart.x_label = "East, m (north is up)";
  panel.y = Axis::linear(my - 0.5 * scale * high_px, my + 0.5 * scale * high_px);
}

Extremes extremes_along_x(const std::vector<Line>& lines) {
  std::vector<Line> turned = lines;
  for (Line& line : turned) std::swap(line.x, line.y);
  return extremes_of(turned);
}

std::string names_of(const Panel& panel) {
  std::string out = "<p class=\"legend\">";
  for (const Line& line : panel.lines)
    out += "<span class=\"tag keep " + run_class(line.run) +
           "\"><svg class=\"swatch\" viewBox=\"0 0 22 8\" aria-hidden=\"true\"><path d=\"M1 4H21\"/></svg>" +
           escape_html(line.name) + "</span> ";
  return out + "</p>\n";
}

/// The curve as the panel's next line, with the words beside its points.
void add_line(const PaperLine& curve, Panel& panel) {
  const std::size_t colour = panel.lines.size() % kColours;
  for (std::size_t i = 0; i < std::min({curve.labels.size(), curve.x.size(), curve.y.size()}); ++i)
    panel.labels.push_back({.run = colour, .x = curve.x[i], .y = curve.y[i], .text = curve.labels[i]});
  panel.lines.push_back({.run = colour,
                         .name = curve.name,
                         .x = curve.x,
                         .y = curve.y,
                         .style = curve.points ? Line::Style::kPoints : Line::Style::kNormal,
                         .whole = curve.from_above});
}

/// One drawing a panel: each has its own lines, and those from above are to scale.
std::string drawings(const PaperSection& part) {
  std::vector<std::string> names;
  for (const PaperLine& line : part.curves)
    if (std::ranges::find(names, line.panel) == names.end()) names.push_back(line.panel);
  std::string out;
  for (std::size_t k = 0; k < names.size(); ++k) {
    Panel panel{.title = names[k]};
    bool to_scale = false;
    for (const PaperLine& line : part.curves) {
      if (line.panel != names[k] || line.x.empty()) continue;
      panel.unit = line.unit;
      to_scale = line.from_above;
      add_line(line, panel);
    }
    const Extremes x = extremes_along_x(panel.lines), y = extremes_of(panel.lines);
    if (!x.drawn || !y.drawn) continue;
    Chart chart{.id = part.name + "-" + std::to_string(k),
                .x = Axis::linear(x.min, x.max, 9),
                .x_label = part.x_label,
                .solid = true,
                .title = part.title,
                .description = names[k],
                .panels = {},
                .marks = {}};
    panel.y = Axis::linear_rounded(y.min, y.max);
    if (to_scale) draw_to_scale(chart, panel, x, y);
    const std::string legend = names_of(panel);
    chart.panels.push_back(std::move(panel));
    out += legend + figure(draw(chart), escape_html(part.title));
  }
  return out;
}

std::string part_section(const PaperSection& part) {
  std::string intro =
      "<b>The paper:</b> " + escape_html(part.paper_says) + "<br><b>Ours:</b> " + escape_html(part.made);
  std::string body = number_table(part);
  for (const std::string& line : part.difference) body += note(line);
  return section(part.name, part.title, intro, body + drawings(part));
}

std::string head(const PaperSummary& summary) {
  std::string out = "<header>\n<p class=\"kicker\">Canyon \xC2\xB7 satellites: " + escape_html(summary.ephemeris) +
                    ", from " + escape_html(summary.start) +
                    " GPS time</p>\n<h1>Durst &amp; Goodin 2012, beside ours</h1>\n<nav "
                    "aria-label=\"Contents\">";
  for (const PaperSection& part : summary.parts)
    out += "<a href=\"#" + escape_html(part.name) + "\">" + escape_html(part.title.substr(0, part.title.find(':'))) +
           "</a> ";
  return out + "</nav>\n</header>\n<p class=\"intro\">" +
         escape_html("Numbers are medians over " + count_of(summary.draws, "draw", "draws") +
                     " with the least and the most of them" +
                     (summary.missions > 0.0
                          ? "; of missions over " + count_of(summary.missions, "seed", "seeds") +
                                " with 95 % intervals: shares with Wilson's, medians between two of the seeds, "
                                "differences of shares with Newcombe's, mean differences seed by seed with Student's"
                          : std::string()) +
                     "; n is their number, three a draw where three gyroscopes drift. Bold: the form of ours that is "
                     "nearest to the paper's number by ratio.") +
         "</p>\n";
}

}  // namespace

Result<std::string> reproduce_page(const std::string& summary_path) {
  CANYON_TRY(const PaperSummary summary, read_paper_summary(summary_path));
  std::string out = head(summary);
  for (const PaperSection& part : summary.parts) {
    throw_if_cancelled();
    out += part_section(part);
  }
  if (!(summary.missions > 0.0))
    out += note("The mission (figures 8 to 10) was not driven: canyon reproduce --missions N.");
  return whole_page("Canyon: Durst & Goodin 2012 reproduced", kColours, out);
}

}  // namespace canyon::report
