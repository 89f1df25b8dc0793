#include "canyon/report/tradeoff/ladder_section.h"

#include <algorithm>
#include <cmath>

#include "canyon/report/draw/chart.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/format.h"

namespace canyon::report {
namespace {

constexpr double kMs = 1e3;

std::size_t colour_of(const TradeoffModel& model) {
  if (model.in_use) return kInUse;
  if (model.is_reference) return kReference;
  return model.on_front ? kFront : kDominated;
}

/// Where a model stands in the diagram: the reference at what it errs itself, if that is known. NaN: nowhere.
double height_of(const TradeoffModel& model, const TradeoffLadder& ladder) {
  const double error = model.is_reference ? ladder.reference_error : model.error;
  return error > 0.0 ? error : kNaN;
}

bool is_drawn(const TradeoffModel& model, const TradeoffLadder& ladder) {
  return model.cpu_s > 0.0 && std::isfinite(height_of(model, ladder));
}

void draw_model(const TradeoffModel& model, const TradeoffLadder& ladder, Panel& panel) {
  const std::size_t colour = colour_of(model);
  const double x = kMs * model.cpu_s, y = height_of(model, ladder);
  panel.lines.push_back({.run = colour, .name = model.name, .x = {x}, .y = {y}, .style = Line::Style::kPoints});
  panel.lines.push_back({.run = colour,
                         .name = model.name + ", least and most",
                         .x = {kMs * model.cpu_low_s, kMs * model.cpu_high_s},
                         .y = {y, y},
                         .style = Line::Style::kThin});
  if (!model.is_reference && model.error_low > 0.0)
    panel.lines.push_back({.run = colour,
                           .name = model.name + ", 95 %",
                           .x = {x, x * 1.000001},
                           .y = {model.error_low, model.error_high},
                           .style = Line::Style::kThin});
  panel.labels.push_back({colour, x, y, model.name});
}

/// The staircase below which no model lies.
Line front_line(const TradeoffLadder& ladder) {
  std::vector<const TradeoffModel*> front;
  for (const TradeoffModel& model : ladder.models)
    if (model.on_front && is_drawn(model, ladder)) front.push_back(&model);
  std::sort(front.begin(), front.end(), [](const auto* a, const auto* b) { return a->cpu_s < b->cpu_s; });
  Line line{.run = kFront, .name = "front"};
  line.style = Line::Style::kStep;
  for (const TradeoffModel* model : front) {
    line.x.push_back(kMs * model->cpu_s);
    line.y.push_back(height_of(*model, ladder));
  }
  return line;
}

/// Whole decades where there are several, else no more than there is to see.
Axis scale(double min, double max) {
  return max > 10.0 * min ? Axis::decades(min, max) : Axis::logarithmic(min, max);
}

Chart chart_of(const TradeoffLadder& ladder, const std::string& id) {
  Panel panel{.title = ladder.error_is, .unit = ladder.unit};
  panel.height_px = 230;
  double low_x = INFINITY, high_x = 0.0;
  for (const TradeoffModel& model : ladder.models) {
    if (!is_drawn(model, ladder)) {
      if (std::isfinite(model.cpu_s))
        panel.notes.push_back(model.name + ": " + show_quantity(kMs * model.cpu_s, "ms per s") +
                              (model.is_reference   ? ", the reference, whose own error nothing here tells"
                               : model.error == 0.0 ? ", no difference"
                                                    : ", no error defined"));
      continue;
    }
    draw_model(model, ladder, panel);
    low_x = std::min(low_x, kMs * model.cpu_low_s);
    high_x = std::max(high_x, kMs * model.cpu_high_s);
  }
  const Extremes y = positive_extremes_of(panel.lines);
  if (y.drawn) {
    panel.y = scale(0.8 * y.min, 1.25 * y.max);
    panel.lines.push_back(front_line(ladder));
  }
  if (ladder.reference_error > 0.0) panel.limit = ladder.reference_error;
  Chart chart{.id = id,
              .x = high_x > 0.0 ? scale(0.9 * low_x, 1.1 * high_x) : Axis::decades(1.0, 10.0),
              .x_label = "CPU time, ms per simulated second",
              .solid = true,
              .title = "Work and precision of " + ladder.key,
              .description = std::to_string(ladder.models.size()) + " models of " + ladder.key + ": " +
                             ladder.error_is + " over CPU time, both logarithmic.",
              .panels = {},
              .marks = {}};
  chart.panels.push_back(std::move(panel));
  return chart;
}

std::string remarks(const TradeoffModel& model) {
  std::vector<std::string> words;
  if (model.on_front) words.push_back("on the front");
  if (model.in_use) words.push_back("in use");
  if (!model.resolved) words.push_back("unresolved: below the reference\xE2\x80\x99s own error");
  if (model.undefined_share >= 5e-4) words.push_back(show_share(model.undefined_share) + " undefined");
  if (!model.tied_with.empty())
    words.push_back("tied in time with " + (model.tied_with.size() > 3
                                                ? std::to_string(model.tied_with.size()) + " others"
                                                : listed(model.tied_with)));
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : "; ") + word;
  return out;
}

std::string table_of(const TradeoffLadder& ladder) {
  std::string out = "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Models of " +
                    escape_html(ladder.key) + "\"><table>\n<thead><tr><th scope=\"col\" class=\"text\">model</th><th>" +
                    escape_html(ladder.error_is + ", " + ladder.unit) +
                    "</th><th>95 %</th><th>CPU, ms per s</th><th>least\xE2\x80\x93most</th><th>work</th><th>MB</th>"
                    "<th class=\"text\">remarks</th></tr></thead>\n<tbody>";
  for (const TradeoffModel& model : ladder.models)
    out += "<tr><th scope=\"row\">" + escape_html(model.name) + "</th><td>" +
           (model.is_reference ? std::string("reference") : show_number(model.error)) + "</td><td>" +
           (std::isfinite(model.error_low) && !model.is_reference
                ? show_number(model.error_low) + "\xE2\x80\x93" + show_number(model.error_high)
                : std::string()) +
           "</td><td>" + show_number(kMs * model.cpu_s) + "</td><td>" + show_number(kMs * model.cpu_low_s) +
           "\xE2\x80\x93" + show_number(kMs * model.cpu_high_s) + "</td><td>" + show_count(model.work) + "</td><td>" +
           show_number(model.memory_mb) + "</td><td class=\"text remarks\">" + escape_html(remarks(model)) +
           "</td></tr>\n";
  return out + "</tbody></table></div>\n";
}

std::string caption_of(const TradeoffLadder& ladder) {
  std::string text = "Measured: " + ladder.meaning + ".";
  if (std::isfinite(ladder.reference_error) && ladder.reference_error > 0.0)
    text += " The reference, " + ladder.reference + ", itself errs " +
            show_quantity(ladder.reference_error, ladder.unit) + " (extrapolated, the level line).";
  if (std::isfinite(ladder.order_observed) || std::isfinite(ladder.order_theory)) {
    text += " Order observed: " + (std::isfinite(ladder.order_observed) ? show_number(ladder.order_observed)
                                                                        : std::string("none above rounding"));
    if (std::isfinite(ladder.order_theory)) text += ", theory: " + show_number(ladder.order_theory);
    text += ladder.order_holds ? "." : ": it is not what its row says.";
  }
  if (std::isfinite(ladder.per_work_s))
    text += " Time by work: " + show_quantity(1e9 * ladder.per_work_s, "ns") + " each (" + ladder.work_unit +
            "), within a factor " + show_number(ladder.worst_ratio) + ".";
  return text;
}

}  // namespace

std::string ladder_section(const TradeoffLadder& ladder, const std::string& id) {
  std::string body = figure(draw(chart_of(ladder, id + "-chart")), escape_html(caption_of(ladder)));
  body += table_of(ladder);
  for (const std::string& one : ladder.left_out) body += note("Left out: " + one);
  const std::string of = ladder.of.empty() ? "" : ", " + ladder.of;
  return section(id, ladder.part + ": " + ladder.key + of, "", body);
}

}  // namespace canyon::report
