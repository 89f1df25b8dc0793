#include "canyon/report/draw/chart.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/config/text.h"
#include "canyon/report/draw/plot_area.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"

namespace canyon::report {
namespace {

constexpr double kWidth = 1000;        // of a plot's own units; it is stretched to the page
constexpr std::size_t kBuckets = 700;  // decimation: about one a pixel of a wide page, on a phone two
constexpr int kLane_px = 7;

/// Draws the panels of one chart.
class ChartWriter {
 public:
  explicit ChartWriter(const Chart& chart) : chart_(chart) {}

  std::string write() {
    out_ = std::string("<div class=\"chart") + (chart_.solid ? " solid" : "") + "\" id=\"" + chart_.id + "\"";
    if (chart_.time) out_ += " data-time=\"\"";
    out_ += " data-x=\"" + axis_data(chart_.x) + "\">\n";
    for (std::size_t i = 0; i < chart_.panels.size(); ++i) panel(chart_.panels[i], i);
    x_axis();
    return out_ + "</div>\n";
  }

 private:
  /// "min max log|lin": what the read-out needs to turn places into values.
  static std::string axis_data(const Axis& axis) {
    // Nine decimals would make nothing of a logarithmic axis's small end.
    const auto end = [&](double v) { return axis.is_logarithmic() && v < 1e-3 ? number_text(v) : fixed(v, 9); };
    return end(axis.min()) + " " + end(axis.max()) + (axis.is_logarithmic() ? " log" : " lin");
  }

  PlotArea area_of(const Panel& panel) const {
    return {.x = chart_.x,
            .y = panel.y,
            .width = kWidth,
            .height = static_cast<double>(panel.height_px),
            .beyond = 1e4,
            .foot = static_cast<double>(kLane_px) * static_cast<double>(panel.lanes.size())};
  }
  double x_px(double x) const { return kWidth * chart_.x.place(x); }

  void panel(const Panel& panel, std::size_t index) {
    const std::string id = chart_.id + "-" + std::to_string(index);
    const int lanes_px = kLane_px * static_cast<int>(panel.lanes.size());
    const int height_px = panel.height_px + lanes_px;
    out_ += "<div class=\"panel\"><p class=\"panel-head\"><span>" + escape_html(panel.title);
    if (!panel.unit.empty()) out_ += "<span class=\"unit\">, " + escape_html(panel.unit) + "</span>";
    out_ += "</span><span class=\"readout\" aria-hidden=\"true\"></span></p>\n";
    out_ += "<div class=\"plot\" style=\"height:" + std::to_string(height_px) + "px\" data-y=\"" + axis_data(panel.y) +
            "\" data-height=\"" + std::to_string(panel.height_px) + "\" data-unit=\"" + escape_html(panel.unit) +
            "\">\n";
    out_ += "<svg viewBox=\"0 0 1000 " + std::to_string(height_px) +
            "\" preserveAspectRatio=\"none\" role=\"img\" aria-labelledby=\"" + id + "-t " + id + "-d\"><title id=\"" +
            id + "-t\">" + escape_html(title_of(panel)) + "</title><desc id=\"" + id + "-d\">" +
            escape_html(index == 0 ? chart_.description : describe(panel)) + "</desc>\n";
    const PlotArea area = area_of(panel);
    grid(panel, area);
    for (const Band& band : panel.bands)
      out_ += "<path class=\"band " + run_class(band.run) + "\" d=\"" + band_path(area, band, kBuckets) + "\"/>\n";
    for (const Mark& mark : chart_.marks)
      if (shows(panel, mark)) draw_mark(mark, height_px);
    // The first line lies uppermost.
    for (auto line = panel.lines.rbegin(); line != panel.lines.rend(); ++line) draw_line(area, *line);
    lanes(panel);
    out_ += "</svg>\n";
    y_labels(area, height_px);
    if (index == 0 || panel.marks_of) mark_labels(panel);
    point_labels(panel, area, height_px);
    out_ += "</div>\n";
    for (const std::string& note : panel.notes) out_ += "<p class=\"note\">" + escape_html(note) + "</p>\n";
    out_ += "</div>\n";
  }

  std::string title_of(const Panel& panel) const {
    return chart_.title + ": " + panel.title + (panel.unit.empty() ? "" : ", " + panel.unit);
  }

  static std::string describe(const Panel& panel) {
    std::string text;
    for (const Line& line : panel.lines) {
      const Extremes e = extremes_of({line});
      if (!text.empty()) text += "; ";
      text += line.name +
              (e.drawn ? " from " + show_number(e.min) + " to " + show_quantity(e.max, panel.unit) : " has no values");
    }
    return text.empty() ? "Nothing to draw." : text + ".";
  }

  void grid(const Panel& panel, const PlotArea& area) {
    const auto level = [&](const char* name, double y) {
      out_ += std::string("<path class=\"") + name + "\" d=\"M0 " + fixed(area.y_px(y), 2) + "H1000\"/>\n";
    };
    out_ += "<path class=\"grid\" d=\"" + grid_path(area, GridTicks::kAll) + "\"/>\n";
    if (panel.limit) level("limit", *panel.limit);
    if (panel.zero_line) level("zero", 0);
  }

  static const char* style_class(Line::Style style) {
    return style == Line::Style::kThin ? " thin" : style == Line::Style::kPoints ? " points" : "";
  }

  void draw_line(const PlotArea& area, const Line& line) {
    const std::size_t buckets = line.whole ? std::max<std::size_t>(line.x.size(), 1) : kBuckets;
    out_ += "<path class=\"line " + run_class(line.run) + style_class(line.style) + "\" data-name=\"" +
            escape_html(line.name) + "\" d=\"" + line_path(area, line, buckets) + "\"/>\n";
  }

  void draw_mark(const Mark& mark, int height_px) {
    out_ += "<path class=\"mark " + run_class(mark.run) + "\" d=\"M" + fixed(x_px(mark.x), 1) + " 0V" +
            std::to_string(height_px) + "\"/>\n";
  }

  static bool shows(const Panel& panel, const Mark& mark) {
    return std::isfinite(mark.x) && (!panel.marks_of || *panel.marks_of == mark.run);
  }

  void mark_labels(const Panel& panel) {
    for (std::size_t i = 0; i < chart_.marks.size(); ++i) {
      const Mark& mark = chart_.marks[i];
      if (!shows(panel, mark)) continue;
      const double place = chart_.x.place(mark.x);
      // Words that would cover one another stand on lines of their own.
      int line = 0;
      for (std::size_t k = 0; k < i; ++k)
        line += shows(panel, chart_.marks[k]) && std::abs(chart_.x.place(chart_.marks[k].x) - place) < 0.25 ? 1 : 0;
      out_ += "<span class=\"mark-label " + run_class(mark.run) + (place > 0.5 ? " left" : "") +
              "\" style=\"left:" + fixed(100 * place, 2) + "%;top:" + fixed(0.1 + line * 1.05, 2) + "rem\">" +
              escape_html(mark.text) + "</span>\n";
    }
  }

  /// Words above and to the right of their places, left of those near the right border; each moves down until none
  /// before it is covered.
  void point_labels(const Panel& panel, const PlotArea& area, int height_px) {
    constexpr double kLine_px = 13.0, kLetter = 7.0;  // of a page 1000 units wide
    constexpr double kCovers_px = 0.999 * kLine_px;   // a box moved by a line may round to a little less than one
    struct Box {
      double left, right, top_px;
    };
    std::vector<Box> taken;
    for (const PointLabel& label : panel.labels) {
      const double x = x_px(label.x), length = kLetter * static_cast<double>(label.text.size());
      if (!std::isfinite(x) || !std::isfinite(area.y_px(label.y))) continue;
      const bool left = x + length > kWidth;
      Box box{left ? x - length : x, left ? x : x + length, area.y_px(label.y) - kLine_px};
      for (bool moved = true; moved;) {
        moved = false;
        for (const Box& other : taken)
          if (box.left < other.right && other.left < box.right && std::abs(box.top_px - other.top_px) < kCovers_px)
            box.top_px = other.top_px + kLine_px, moved = true;
      }
      taken.push_back(box);
      out_ += "<span class=\"point-label " + run_class(label.run) + (left ? " left" : "") +
              "\" style=\"left:" + fixed(100 * x / kWidth, 2) + "%;top:" + fixed(100 * box.top_px / height_px, 2) +
              "%\">" + escape_html(label.text) + "</span>\n";
    }
  }

  void lanes(const Panel& panel) {
    for (std::size_t i = 0; i < panel.lanes.size(); ++i) {
      const int top_px = panel.height_px + kLane_px * static_cast<int>(i) + 1;
      std::string path;
      double drawn_to = -1;
      for (const auto& [from, to] : panel.lanes[i].intervals) {
        // At least half a pixel wide; what the bar before already covers is left out.
        const double a = std::max(x_px(from), drawn_to), b = std::max(x_px(to), x_px(from) + 0.7);
        if (b <= a) continue;
        path += "M" + fixed(a, 1) + " " + std::to_string(top_px) + "H" + fixed(b, 1) + "v" +
                std::to_string(kLane_px - 2) + "H" + fixed(a, 1) + "z";
        drawn_to = b;
      }
      out_ += "<path class=\"lane " + run_class(panel.lanes[i].run) + "\" d=\"" + path + "\"><title>" +
              escape_html(panel.lanes[i].name) + "</title></path>\n";
    }
  }

  void y_labels(const PlotArea& area, int height_px) {
    for (const Tick& tick : area.y.ticks()) {
      if (tick.label.empty()) continue;
      out_ +=
          "<span class=\"yt\" aria-hidden=\"true\" style=\"top:" + fixed(100 * area.y_px(tick.value) / height_px, 2) +
          "%\">" + tick.label + "</span>\n";
    }
  }

  void x_axis() {
    out_ += "<div class=\"xaxis\" aria-hidden=\"true\">";
    for (const Tick& tick : chart_.x.ticks()) {
      if (tick.label.empty()) continue;
      out_ += "<span class=\"xt\" style=\"left:" + fixed(100 * chart_.x.place(tick.value), 2) + "%\">" + tick.label +
              "</span>";
    }
    out_ += "</div><p class=\"xlabel\" aria-hidden=\"true\">" + escape_html(chart_.x_label) + "</p>\n";
  }

  const Chart& chart_;
  std::string out_;
};

template <class Accept>
Extremes extremes_if(const std::vector<Line>& lines, Accept accept) {
  Extremes e;
  for (const Line& line : lines) {
    for (const double y : line.y) {
      if (!std::isfinite(y) || !accept(y)) continue;
      if (!e.drawn) e = {y, y, true};
      e.min = std::min(e.min, y);
      e.max = std::max(e.max, y);
    }
  }
  return e;
}

}  // namespace

std::string draw(const Chart& chart) {
  return ChartWriter(chart).write();
}

Extremes extremes_of(const std::vector<Line>& lines) {
  return extremes_if(lines, [](double) { return true; });
}

Extremes positive_extremes_of(const std::vector<Line>& lines) {
  return extremes_if(lines, [](double y) { return y > 0; });
}

}  // namespace canyon::report
