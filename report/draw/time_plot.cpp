#include "canyon/report/draw/time_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "canyon/report/draw/axis.h"
#include "canyon/report/draw/format.h"
#include "canyon/report/read/decimate.h"

namespace canyon::report {
namespace {

constexpr double kLeft = 96, kWidth = 780, kTop = 56, kHeight = 180, kGap = 52, kFoot = 48;
constexpr std::size_t kBuckets = 780;  // one a pixel
// Okabe & Ito (2008).
constexpr std::array<const char*, 4> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7"};

Axis axis_of(const TimePanel& panel) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const TimeCurve& curve : panel.curves)
    for (const double y : curve.y)
      if (std::isfinite(y)) low = std::min(low, y), high = std::max(high, y);
  return low <= high ? Axis::linear_rounded(low, high) : Axis::linear(0, 1);
}

class PlotWriter {
 public:
  PlotWriter(const std::string& title, const std::vector<TimePanel>& panels) : panels_(panels), time_(time_axis()) {
    const double height = kTop + static_cast<double>(panels.size()) * (kHeight + kGap) + kFoot - kGap;
    out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + fixed(kLeft + kWidth + 24, 0) + " " +
           fixed(height, 0) + "\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#1b1f23\">\n<title>" +
           escape_html(title) + "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
    text(kLeft, 24, title, "font-size=\"16\" font-weight=\"600\"");
  }

  std::string write() {
    for (std::size_t i = 0; i < panels_.size(); ++i)
      panel(panels_[i], kTop + static_cast<double>(i) * (kHeight + kGap));
    const double foot = kTop + static_cast<double>(panels_.size()) * (kHeight + kGap) - kGap;
    for (const Tick& tick : time_.ticks())
      text(x_px(tick.value), foot + 18, tick.label, "text-anchor=\"middle\" fill=\"#59636d\"");
    text(kLeft + kWidth / 2, foot + 38, "time from start, s", "text-anchor=\"middle\" fill=\"#59636d\"");
    return out_ + "</svg>\n";
  }

 private:
  Axis time_axis() const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const TimePanel& panel : panels_)
      for (const TimeCurve& curve : panel.curves)
        if (!curve.t_s.empty()) low = std::min(low, curve.t_s.front()), high = std::max(high, curve.t_s.back());
    return low <= high ? Axis::seconds(low, high) : Axis::seconds(0, 1);
  }
  double x_px(double t_s) const { return kLeft + kWidth * time_.place(t_s); }

  void text(double x, double y, const std::string& words, const std::string& attributes) {
    out_ += "<text x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" " + attributes + ">" + escape_html(words) +
            "</text>\n";
  }

  void panel(const TimePanel& panel, double top) {
    const Axis y = axis_of(panel);
    text(kLeft, top - 10, panel.title + (panel.unit.empty() ? "" : ", " + panel.unit), "font-weight=\"600\"");
    std::string grid;
    for (const Tick& tick : y.ticks()) {
      const double py = top + kHeight * (1 - y.place(tick.value));
      grid += "M" + fixed(kLeft, 1) + " " + fixed(py, 1) + "h" + fixed(kWidth, 1);
      text(kLeft - 8, py + 4, tick.label, "text-anchor=\"end\" fill=\"#59636d\"");
    }
    for (const Tick& tick : time_.ticks())
      grid += "M" + fixed(x_px(tick.value), 1) + " " + fixed(top, 1) + "v" + fixed(kHeight, 1);
    out_ += "<path d=\"" + grid + "\" stroke=\"#e0e4e8\" fill=\"none\"/>\n";
    double legend = kLeft + kWidth;
    for (std::size_t i = panel.curves.size(); i-- > 0;) {
      const char* colour = kColours[i % kColours.size()];
      draw(panel.curves[i], y, top, colour);
      text(legend, top - 10, panel.curves[i].name, std::string("text-anchor=\"end\" fill=\"") + colour + "\"");
      legend -= 16 + 7.2 * static_cast<double>(panel.curves[i].name.size());
    }
  }

  void draw(const TimeCurve& curve, const Axis& y, double top, const char* colour) {
    std::string path;
    for (const LinePiece& piece : decimate(curve.t_s, curve.y, kBuckets)) {
      char command = 'M';
      for (const std::size_t i : piece) {
        path += command + fixed(x_px(curve.t_s[i]), 1) + " " + fixed(top + kHeight * (1 - y.place(curve.y[i])), 1);
        command = 'L';
      }
    }
    out_ += "<path d=\"" + path + "\" stroke=\"" + colour +
            "\" fill=\"none\" stroke-linejoin=\"round\" stroke-width=\"1.4\"/>\n";
  }

  const std::vector<TimePanel>& panels_;
  Axis time_;
  std::string out_;
};

}  // namespace

std::string time_plot_svg(const std::string& title, const std::vector<TimePanel>& panels) {
  return PlotWriter(title, panels).write();
}

}  // namespace canyon::report
