#include "canyon/report/draw/picture.h"

#include <array>
#include <cmath>

#include "canyon/report/draw/plot_area.h"
#include "canyon/report/format.h"

namespace canyon::report {
namespace {

constexpr double kLeft = 96, kRight = 24, kFoot = 48, kColumnGap = 96, kRowGap = 52;
constexpr std::size_t kPictureBuckets = 780;  // one a pixel
// Okabe & Ito (2008).
constexpr std::array<const char*, 4> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7"};
constexpr const char* kQuiet = "fill=\"#59636d\"";

std::string colour(std::size_t run) {
  return kColours[run % kColours.size()];
}

class PictureWriter {
 public:
  explicit PictureWriter(const Picture& picture)
      : picture_(picture),
        top_(picture.subtitle.empty() ? 56 : 84),
        width_(picture.side_by_side ? 480 : 780),
        height_(picture.side_by_side ? 400 : 180) {}

  std::string write() {
    const auto n = static_cast<double>(picture_.panels.size());
    const double columns = picture_.side_by_side ? n : 1, rows = picture_.side_by_side ? 1 : n;
    const std::string right = fixed(kLeft + columns * (width_ + kColumnGap) - kColumnGap + kRight, 0);
    const std::string bottom = fixed(top_ + rows * (height_ + kRowGap) - kRowGap + kFoot, 0);
    out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + right + " " + bottom + "\" width=\"" + right +
           "\" height=\"" + bottom +
           "\" font-family=\"system-ui,sans-serif\" font-size=\"13\" fill=\"#1b1f23\">\n<title>" +
           escape_html(picture_.title) + "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
    text(24, 24, picture_.title, "font-size=\"17\" font-weight=\"600\"");
    text(24, 46, picture_.subtitle, kQuiet);
    for (std::size_t i = 0; i < picture_.panels.size(); ++i) {
      const auto k = static_cast<double>(i);
      const PlotArea area{picture_.x,
                          picture_.panels[i].y,
                          kLeft + (picture_.side_by_side ? k * (width_ + kColumnGap) : 0),
                          top_ + (picture_.side_by_side ? 0 : k * (height_ + kRowGap)),
                          width_,
                          height_};
      panel(picture_.panels[i], area);
      if (picture_.side_by_side || i + 1 == picture_.panels.size()) x_axis(area);
    }
    return out_ + "</svg>\n";
  }

 private:
  void text(double x, double y, const std::string& words, const std::string& attributes) {
    if (words.empty()) return;
    out_ += "<text x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" " + attributes + ">" + escape_html(words) +
            "</text>\n";
  }
  void path(const std::string& d, const std::string& attributes, const std::string& name = {}) {
    out_ += "<path " + attributes + " d=\"" + d + "\"" +
            (name.empty() ? std::string("/>") : "><title>" + escape_html(name) + "</title></path>") + "\n";
  }

  void panel(const Panel& panel, const PlotArea& area) {
    text(area.left, area.top - 10, panel.title + (panel.unit.empty() ? "" : ", " + panel.unit), "font-weight=\"600\"");
    path(grid_path(area, GridTicks::kUnlabelled), "stroke=\"#eef0f2\" fill=\"none\"");
    path(grid_path(area, GridTicks::kLabelled), "stroke=\"#d4d9de\" fill=\"none\"");
    for (const Tick& tick : area.y.ticks())
      text(area.left - 8, area.y_px(tick.value) + 4, tick.label, std::string("text-anchor=\"end\" ") + kQuiet);
    for (const Band& band : panel.bands)
      path(band_path(area, band, kPictureBuckets), "fill=\"" + colour(band.run) + "\" opacity=\"0.2\"");
    // The first line lies uppermost.
    double legend = area.left + area.width;
    for (auto line = panel.lines.rbegin(); line != panel.lines.rend(); ++line) {
      const bool points = line->style == Line::Style::kPoints;
      path(line_path(area, *line, kPictureBuckets),
           "class=\"line\" fill=\"none\" stroke=\"" + colour(line->run) +
               (points ? "\" stroke-linecap=\"round\" stroke-width=\"5.2\""
                       : "\" stroke-linejoin=\"round\" stroke-width=\"1.4\""),
           line->name);
      if (line->name.empty()) continue;
      text(legend, area.top - 10, line->name, "text-anchor=\"end\" fill=\"" + colour(line->run) + "\"");
      legend -= 16 + 7.2 * static_cast<double>(line->name.size());
    }
  }

  void x_axis(const PlotArea& area) {
    const double foot = area.top + area.height;
    for (const Tick& tick : area.x.ticks())
      text(area.x_px(tick.value), foot + 18, tick.label, std::string("text-anchor=\"middle\" ") + kQuiet);
    text(area.left + area.width / 2, foot + 38, picture_.x_label, std::string("text-anchor=\"middle\" ") + kQuiet);
  }

  const Picture& picture_;
  double top_, width_, height_;
  std::string out_;
};

/// The x of all lines, as lines of y.
std::vector<Line> over_x(const std::vector<Panel>& panels) {
  std::vector<Line> out;
  for (const Panel& panel : panels)
    for (const Line& line : panel.lines) out.push_back({.y = line.x});
  return out;
}

/// Around the values above zero.
Axis decades_around(const std::vector<Line>& lines) {
  const Extremes e = positive_extremes_of(lines);
  return e.drawn ? Axis::decades(e.min, e.max) : Axis::decades(1, 10);
}

}  // namespace

std::string picture_svg(const Picture& picture) {
  return PictureWriter(picture).write();
}

Picture time_picture(std::string title, std::vector<Panel> panels) {
  const Extremes t = extremes_of(over_x(panels));
  for (Panel& panel : panels) {
    const Extremes e = extremes_of(panel.lines);
    panel.y = e.drawn ? Axis::linear_rounded(e.min, e.max) : Axis::linear(0, 1);
  }
  return {.title = std::move(title),
          .x = Axis::seconds(t.min, t.max),
          .x_label = "time from start, s",
          .panels = std::move(panels)};
}

Picture deviation_picture(std::string title, std::string subtitle, std::vector<Panel> panels) {
  for (Panel& panel : panels) {
    std::vector<Line> drawn = panel.lines;
    for (const Band& band : panel.bands)
      for (const auto* edge : {&band.low, &band.high}) drawn.push_back({.y = *edge});
    panel.y = decades_around(drawn);
  }
  return {.title = std::move(title),
          .subtitle = std::move(subtitle),
          .x = decades_around(over_x(panels)),
          .x_label = "averaging time, s",
          .side_by_side = true,
          .panels = std::move(panels)};
}

}  // namespace canyon::report
